#include "host/labeling/features/feature_families.h"

namespace exemplar {

FeatureMatrix orientation_features(const PreparedMesh& prepared) {
    FeatureMatrix matrix;
    matrix.rows = prepared.face_count();
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
        const std::span<float> column = matrix.add(std::string("orientation.") + "xyz"[axis]);
        for (std::size_t f = 0; f < matrix.rows; ++f) column[f] = prepared.center[f][axis];
    }
    return matrix;
}

}  // namespace exemplar
