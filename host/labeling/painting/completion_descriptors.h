#pragma once

#include <cstddef>
#include <vector>

#include "host/labeling/features/features.h"

namespace exemplar {

/// A short vector per face whose Euclidean distances say how alike the surface is around two faces.
struct FaceDescriptors {
    std::size_t dimensions = 0;
    std::vector<float> values;  ///< faces x dimensions, face-major
};

/// Returns the leading principal components of the unary features (App. A.1): features are standardized over the
/// mesh, clipped at three deviations, and each family counts the same, however many columns it has. The mean squared
/// distance of two faces is 1. Faces are weighted by area. Contextual columns are left out.
FaceDescriptors face_descriptors(const MeshFeatures& features, std::size_t max_dimensions = 40);

}  // namespace exemplar
