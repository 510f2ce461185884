#pragma once

#include <Eigen/Geometry>

#include "host/mesh/mesh.h"

namespace exemplar {

/// Returns twice the area of a face times its unit normal, computed in double precision, in squared mesh units.
inline Vec3d doubled_area_vector(const TriangleMesh& mesh, const Face& face) {
    const Vec3d a = mesh.vertices[face[0]].cast<double>();
    return (mesh.vertices[face[1]].cast<double>() - a).cross(mesh.vertices[face[2]].cast<double>() - a);
}

}  // namespace exemplar
