#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "host/data/catalog/shape_record.h"
#include "host/labeling/features/features.h"
#include "host/labeling/category/shape_descriptor.h"

namespace exemplar {

/// Linear scores of categories on a squashed descriptor, which a single odd value cannot dominate:
///
///     H = offset + weights z,   z_k = tanh((x_k - mean_k) * inverse_deviation_k)
///
/// With the targets of training (1 for a shape's own category, 0 for the others) the scores of a shape sum to 1.
struct CategoryScores {
    std::vector<float> mean, inverse_deviation;  ///< D values of the descriptor; 0 where one did not vary in training
    std::vector<float> weights;                  ///< C x D, row-major
    std::vector<float> offset;                   ///< C

    std::size_t category_count() const { return offset.size(); }
    /// H of a descriptor of D values.
    std::vector<double> of(std::span<const float> descriptor) const;
};

/// How sure scores are: the largest, and by how much it is above the second: 2 for a perfect answer, 1 / C for none.
double category_evidence(std::span<const double> scores);

/// Everything needed to recognize the category of a shape.
struct CategoryModel {
    std::vector<std::string> category_names;
    FeatureOptions feature_options;
    std::vector<std::string> features;  ///< those that descriptors are of, in order
    CategoryScores scores;
    double sharpness = 10;          ///< P(category | one of them) = softmax(sharpness H)
    double evidence_slope = 0;      ///< confidence = sigma(slope * evidence + offset); >= 0
    double evidence_offset = 0;     ///< see evidence_slope
    double least_confidence = 0.5;  ///< a shape of less is called unknown; in [0, 1]
    std::uint64_t seed = 0;
    std::vector<std::string> provenance;  ///< a line per training mesh: category, name and content hash

    std::size_t category_count() const { return category_names.size(); }
};

/// What a model says of a shape.
struct CategoryOpinion {
    std::int32_t category = -1;      ///< index into the model's names; -1: unknown
    std::vector<float> probability;  ///< per category, if it is one of them; they sum to 1
    /// That the most probable category is right, in [0, 1], if one shape in five is of no category of the model.
    float confidence = 0;
};

/// The category of a shape from the features of its faces; contextual ones that labeling has appended do not matter.
/// Throws UsageError for features of other options than model.feature_options.
CategoryOpinion recognize(const CategoryModel& model, const MeshFeatures& features);
/// The same from the descriptor.
CategoryOpinion recognize(const CategoryModel& model, const ShapeDescriptor& shape);

/// Throws UsageError unless names are printable words, each there once, at least two and none of them
/// k_unknown_category.
void require_category_names(std::span<const std::string> names);

/// What the metadata of its file say that it is.
constexpr const char* k_category_model_kind = "exemplar shape categories";
constexpr int k_category_format_version = 1;
/// A bound against absurd files.
constexpr std::size_t k_most_categories = 1000;

/// Writes a safetensors file with all of the model; equal models give equal bytes.
void save_category_model(const std::filesystem::path& path, const CategoryModel& model);
/// Reads and checks a model completely. Throws ModelError: damaged, truncated, newer than this program, made for
/// features or descriptors of another version, or not a model of shape categories.
CategoryModel load_category_model(const std::filesystem::path& path);

}  // namespace exemplar
