#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "host/data/catalog/shape_record.h"
#include "host/labeling/category/shape_descriptor.h"
#include "host/labeling/features/features.h"
#include "host/learn/regression/logistic_regression.h"

namespace exemplar {

/// Linear scores of categories on a squashed descriptor. Squashing keeps a single outlier from dominating:
///
///     H = offset + weights z,   z_k = tanh((x_k - mean_k) * inverse_deviation_k)
///
/// With the targets of training (1 for a shape's own category, 0 for the others) the scores of a shape sum to 1.
struct CategoryScores {
    std::vector<float> mean, inverse_deviation;  ///< D each; the latter is 0 where a value did not vary in training
    std::vector<float> weights;                  ///< C x D, row-major
    std::vector<float> offset;                   ///< C

    std::size_t category_count() const { return offset.size(); }
    /// Returns the C scores H of a descriptor of D values.
    std::vector<double> of(std::span<const float> descriptor) const;
};

/// Returns how decisive C scores are: the largest score plus its lead over the second. It is 2 for a perfect answer,
/// 1 / C if all scores are equal.
double category_evidence(std::span<const double> scores);

/// Everything needed to recognize the category of a shape.
struct CategoryModel {
    std::vector<std::string> category_names;
    FeatureOptions feature_options;
    std::vector<std::string> features;  ///< the face features that descriptors are computed from, in order
    CategoryScores scores;
    double sharpness = 10;        ///< P(category | it is a known one) = softmax(sharpness H)
    LogisticCurve confidence;     ///< probability that the best category is right, by category_evidence
    double min_confidence = 0.5;  ///< shapes with a lower confidence are called unknown; in [0, 1]
    std::uint64_t seed = 0;
    std::vector<std::string> provenance;  ///< one line per training mesh: category, name and content hash

    std::size_t category_count() const { return category_names.size(); }
};

/// The category that a model predicts for a shape.
struct CategoryPrediction {
    std::int32_t category = -1;      ///< index into the model's names; -1: unknown
    std::vector<float> probability;  ///< per category, given that the shape is of a known one; they sum to 1
    /// Probability that the most probable category is right, in [0, 1], if one shape in five is of no known category.
    float confidence = 0;
};

/// Predicts the category of a shape from its face features, ignoring contextual features that labeling has appended.
/// Throws UsageError if the features are not those that the model was trained on (see model.feature_options).
CategoryPrediction recognize(const CategoryModel& model, const MeshFeatures& features);
/// Predicts the category from a descriptor. Throws likewise.
CategoryPrediction recognize(const CategoryModel& model, const ShapeDescriptor& shape);

/// Throws UsageError unless there are at least two names and at most k_max_categories, all different printable
/// words, none of them k_unknown_category.
void require_category_names(std::span<const std::string> names);

/// The entry `kind` in the metadata of a category model's file.
constexpr const char* k_category_model_kind = "exemplar shape categories";
constexpr int k_category_format_version = 1;
/// Maximum number of categories, so that absurd files are rejected.
constexpr std::size_t k_max_categories = 1000;

/// Writes the whole model to a safetensors file; equal models give equal bytes.
void save_category_model(const std::filesystem::path& path, const CategoryModel& model);
/// Reads a model and checks all of it. Throws ModelError if the file is damaged, truncated, newer than this program,
/// made for features or descriptors of another version, or no model of shape categories.
CategoryModel load_category_model(const std::filesystem::path& path);

}  // namespace exemplar
