#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "host/mesh/mesh.h"
#include "shaders/shared/curvature.h"

namespace exemplar {

/// The nearby vertices of each vertex in the layout of the kernels: the row of vertex v starts at texels[begin[v]]
/// (see shared::k_near_last).
struct NearVertices {
    std::vector<std::uint32_t> begin;
    std::vector<shared::uvec4> texels;
};

/// The ball around a vertex whose vertices are near, in mesh units.
struct NearBall {
    double radius = 0;
    double reach = 0;  ///< radius within which vertices are listed; at least `radius`
    std::size_t enough = std::numeric_limits<std::size_t>::max();  ///< see NearFlood; of vertices within `radius`
};

/// Finds for each vertex those that are connected to it by edges inside the ball around it, without itself. Throws
/// UsageError if they take more than `max_texels_per_range`.
NearVertices build_near_vertices(const TriangleMesh& mesh, const NearBall& ball, std::size_t max_texels_per_range);

/// Rows of consecutive vertices: the rows of vertices [first, first + count) are in texels
/// [first_texel, first_texel + texels).
struct NearTile {
    std::uint32_t first;
    std::uint32_t count;
    std::uint32_t first_texel;
    std::uint32_t texels;
};

/// Splits the rows into tiles of at most `max_texels_per_range` that begin at multiples of `alignment`; a tile may thus
/// begin with the end of the previous row. Throws UsageError if a single row is longer.
std::vector<NearTile> tile_rows(const NearVertices& rows, std::size_t max_texels_per_range, std::size_t alignment);

}  // namespace exemplar
