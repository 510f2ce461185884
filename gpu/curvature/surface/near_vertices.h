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

/// Rows of consecutive vertices: those of vertices [first, first + count) are in the `texels` texels from
/// `first_texel`.
struct NearTile {
    std::uint32_t first;
    std::uint32_t count;
    std::uint32_t first_texel;
    std::uint32_t texels;
};

/// Splits the rows so that no tile has more than `most_texels`, and each begins at a multiple of `alignment` (with the
/// end of the row before it, perhaps). Throws UsageError if a single row is longer.
std::vector<NearTile> tile_rows(const NearVertices& rows, std::size_t most_texels, std::size_t alignment);

}  // namespace exemplar
