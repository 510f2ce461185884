#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "host/mesh/mesh.h"

namespace exemplar {

/// What is across the sides of a face (side i runs from corner i to the next): 4 * face + the side of that face, or one
/// of the two below.
using FaceNeighbors = std::array<std::uint32_t, 3>;
/// No other face has the edge.
constexpr std::uint32_t k_no_neighbor = std::numeric_limits<std::uint32_t>::max();
/// Two or more others have it, and this is the first. Lines do not continue there.
constexpr std::uint32_t k_many_neighbors = k_no_neighbor - 1;
/// This is another of such faces, or the side is no edge: its corners are one vertex.
constexpr std::uint32_t k_blocked_side = k_no_neighbor - 2;
constexpr std::uint32_t k_last_neighbor = k_no_neighbor - 3;  ///< no code of a side is larger

/// The neighbors of all faces, found in O(F). Throws MeshError if a face names a vertex that is not there, or there are
/// more faces than the numbers can tell (2^30 - 1).
std::vector<FaceNeighbors> build_face_neighbors(std::span<const Face> faces, std::size_t vertex_count);

}  // namespace exemplar
