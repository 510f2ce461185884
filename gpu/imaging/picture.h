#pragma once

#include <Eigen/Core>

#include "host/imaging/camera.h"
#include "shaders/shared/types.h"

namespace exemplar {

/// The columns of a matrix as shaders take them.
inline void put_matrix(const Eigen::Matrix4f& matrix, shared::vec4 (&columns)[4]) {
    for (int column = 0; column < 4; ++column)
        columns[column] = {matrix(0, column), matrix(1, column), matrix(2, column), matrix(3, column)};
}

/// Whether the eye of a camera is at infinity.
inline bool is_parallel(const Camera& camera) {
    return camera.projection(3, 3) != 0;
}

/// The eye as a homogeneous point: of a parallel projection the unit direction to it, and 0.
inline shared::vec4 homogeneous_eye(const Camera& camera) {
    const bool parallel = is_parallel(camera);
    const Vec3 eye = parallel ? camera.to_eye(Vec3::Zero()) : camera.position();
    return {eye.x(), eye.y(), eye.z(), parallel ? 0.0f : 1.0f};
}

}  // namespace exemplar
