#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "host/labeling/category/shape_descriptor.h"
#include "host/labeling/inference/labeler.h"
#include "host/labeling/inference/model.h"
#include "host/labeling/painting/labeling_folder.h"
#include "host/mesh/mesh.h"

namespace exemplar {

/// Training takes the shapes of a folder that were listed last, at most so many: more would take minutes.
constexpr std::size_t k_max_training_shapes = 24;

/// Learns from the verified shapes of a folder, with the options of suggestion_training(). Returns null if there are
/// fewer than two labels to learn. `cache`: of features. Throws what load_corpus, cached_features and train_labeling
/// throw.
std::shared_ptr<const LabelingModel> learn_from_verified(std::span<const FolderShape> shapes,
                                                         const std::filesystem::path& cache,
                                                         const LabelingBackend& backend);

/// A shape of a folder as a model labels it.
struct SuggestedShape {
    TriangleMesh mesh;
    std::vector<std::int32_t> label;  ///< per face of the file: an index into the palette, or -1
    std::vector<float> confidence;    ///< per triangle of the mesh
    float uncertainty = 1;            ///< 1 minus the mean confidence over the surface, above 0
    ShapeDescriptor descriptor;
};
SuggestedShape suggest_shape(const LabelingModel& model, const std::filesystem::path& path,
                             std::span<const std::string> palette, const std::filesystem::path& cache,
                             const LabelingBackend& backend);

}  // namespace exemplar
