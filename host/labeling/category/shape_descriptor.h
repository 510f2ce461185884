#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "host/labeling/features/features.h"

namespace exemplar {

/// Describes a whole shape by statistics of its face features: for each feature the mean over the surface, the
/// standard deviation, and the correlation with `geodesic.mean` (is the feature larger at the ends of limbs than in
/// the middle?). Faces are weighted by area. Like the features, the values do not change when the shape is moved,
/// rotated or scaled, and change little when it is meshed differently.
struct ShapeDescriptor {
    std::vector<std::string> features;  ///< names of the face features
    std::vector<float> values;          ///< k_shape_statistics x features: all means, then deviations, correlations
};
constexpr std::size_t k_shape_statistics = 3;

/// Version of the statistics (the features have their own, k_feature_version); changes whenever the values change.
constexpr int k_shape_descriptor_version = 1;

/// Computes the descriptor from the unary features, except those that labeling appends (is_appended). A feature that
/// does not vary has deviation and correlation 0. If no face has area, all faces count equally. All values are finite
/// if the features are. Runs on all cores; the result does not depend on their number. Throws UsageError if there are
/// no faces, or no feature `geodesic.mean`.
ShapeDescriptor compute_shape_descriptor(const MeshFeatures& features);

}  // namespace exemplar
