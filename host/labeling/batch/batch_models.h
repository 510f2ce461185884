#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "host/labeling/category/category_model.h"
#include "host/labeling/inference/model.h"

namespace exemplar {

/// A labeling model and its file.
struct BatchModel {
    std::string name;  ///< name of the file without extension: the category that the model labels
    std::string hash;  ///< hash of the file's content
    LabelingModel model;
};

/// The models of a batch run: one model for all shapes, or one model per category, optionally with a model that
/// recognizes the category.
struct BatchModels {
    std::vector<BatchModel> models;
    std::optional<CategoryModel> recognizer;
    std::string recognizer_hash;   ///< empty without a recognizer
    FeatureOptions features;       ///< the options that all models share
    bool is_single_model = false;  ///< the only model labels every shape, whatever its category

    /// Returns the model of a category, ignoring case; null if there is none.
    const BatchModel* of_category(const std::string& category) const;
    /// Returns a text that identifies the models by their names and contents.
    std::string key() const;
};

/// Reads one labeling model, or all models of a folder (.safetensors): labeling models, each named after its
/// category, and at most one that recognizes categories. Throws DataError if there is none, ModelError naming a model
/// that is damaged or uses other feature options than the rest.
BatchModels load_batch_models(const std::filesystem::path& path);

}  // namespace exemplar
