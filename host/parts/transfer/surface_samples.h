#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "host/mesh/mesh.h"

namespace exemplar {

/// Points on a surface; those of one face are neighbors in the lists.
struct SurfaceSamples {
    std::vector<Vec3> points;
    std::vector<std::uint32_t> face;   ///< per point
    std::vector<std::uint32_t> begin;  ///< per face its first point, then the number of points
    double spacing = 0;                ///< side of a square of the area per point that was asked for
};

/// Spreads about `count` points over the area, at least one and at most `most` per face. A face has them in a regular
/// pattern (at the centers of its division into k x k similar triangles), which depends on nothing else.
SurfaceSamples sample_faces(const TriangleMesh& mesh, std::size_t count, std::size_t most);

}  // namespace exemplar
