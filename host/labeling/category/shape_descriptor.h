#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "host/labeling/features/features.h"

namespace exemplar {

/// What a shape is like as a whole, from the features of its faces: of each feature the mean over the surface, the
/// standard deviation, and the correlation with `geodesic.mean`, which says whether the feature is larger at the ends
/// of limbs than in the middle. Faces count by area. Features do not change when a shape is moved, turned or scaled,
/// and little when it is meshed otherwise; the same holds for these.
struct ShapeDescriptor {
    std::vector<std::string> features;  ///< names of the features of the faces
    std::vector<float> values;          ///< k_shape_statistics x features: all means, then deviations, correlations
};
constexpr std::size_t k_shape_statistics = 3;

/// Identifies the meaning of the values beyond that of the features; changes whenever it changes.
constexpr int k_shape_descriptor_version = 1;

/// Describes the unary features but for the contextual ones, which labeling appends and which tell of labels. What does
/// not vary has the deviation and the correlation 0. Without any area all faces count as equal. All values are finite
/// if the features are. Runs on all cores; the result does not depend on their number. Throws UsageError without faces,
/// or without a feature `geodesic.mean`.
ShapeDescriptor compute_shape_descriptor(const MeshFeatures& features);

}  // namespace exemplar
