#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "host/labeling/category/category_model.h"
#include "host/labeling/inference/model.h"

namespace exemplar {

/// A labeling model and where it is from.
struct BatchModel {
    std::string name;  ///< of its file, without extension: the category that it labels
    std::string hash;  ///< of its file's content
    LabelingModel model;
};

/// The models of a batch run: one that labels everything, or one per category, with or without one that recognizes the
/// category.
struct BatchModels {
    std::vector<BatchModel> models;
    std::optional<CategoryModel> recognizer;
    std::string recognizer_hash;  ///< empty without
    FeatureOptions features;      ///< that all of them want
    bool is_one_for_all = false;  ///< the only model labels every shape, whatever its category

    /// The model for a category that was given or recognized, whose case does not matter; null if there is none.
    const BatchModel* of_category(const std::string& category) const;
    /// Equal for models of equal content.
    std::string key() const;
};

/// Reads a labeling model, or all models of a folder (.safetensors): labeling models, each named after its category,
/// and at most one that recognizes categories. Throws DataError where there is none, ModelError naming a model that is
/// damaged or wants other features than the rest.
BatchModels load_batch_models(const std::filesystem::path& path);

}  // namespace exemplar
