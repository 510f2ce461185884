#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "host/mesh/mesh.h"
#include "shaders/shared/curvature.h"

namespace exemplar {

/// For each vertex those around it, as kernels gather them: the row of vertex v starts at texels[begin[v]] (see
/// shared::k_near_last).
struct NearVertices {
    std::vector<std::uint32_t> begin;
    std::vector<shared::uvec4> texels;
};

/// The vertices that are reached from each over edges without leaving the ball of this radius around it, in mesh units;
/// without the vertex itself. Throws UsageError if that takes more than `most_texels`.
NearVertices build_near_vertices(const TriangleMesh& mesh, double radius, std::size_t most_texels);

}  // namespace exemplar
