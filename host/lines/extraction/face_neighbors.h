#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "host/mesh/mesh.h"

namespace exemplar {

/// What is across the three sides of a face (side i runs from corner i to the next): 4 * face + side of the other
/// face, or one of the constants below.
using FaceNeighbors = std::array<std::uint32_t, 3>;
/// No other face has the edge.
constexpr std::uint32_t k_no_neighbor = std::numeric_limits<std::uint32_t>::max();
/// Two or more other faces have the edge, and this is the first of them. Lines do not continue there.
constexpr std::uint32_t k_nonmanifold_neighbors = k_no_neighbor - 1;
/// Two or more other faces have the edge, and this is not the first; or both corners of the side are one vertex.
constexpr std::uint32_t k_blocked_side = k_no_neighbor - 2;
constexpr std::uint32_t k_max_neighbor_code = k_no_neighbor - 3;  ///< maximum value of 4 * face + side

/// Finds the neighbors of all faces in O(F). Throws MeshError if a face has a vertex that does not exist, or there
/// are more faces than can be numbered (2^30 - 1).
std::vector<FaceNeighbors> build_face_neighbors(std::span<const Face> faces, std::size_t vertex_count);

}  // namespace exemplar
