#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "host/mesh/mesh.h"

namespace exemplar {

/// The neighbors of a face across its three sides; side i runs from corner i to the next. Each is a code, 4 * face +
/// side of the other face, with the flags below, or one of the two constants. Lines continue across a side whose entry
/// is at most k_max_neighbor_code.
using FaceNeighbors = std::array<std::uint32_t, 3>;
/// No other face has the edge.
constexpr std::uint32_t k_no_neighbor = std::numeric_limits<std::uint32_t>::max();
/// Two other sides stand for the edge, which more than two faces have; or both corners of the side are one vertex.
constexpr std::uint32_t k_blocked_side = k_no_neighbor - 1;
/// Flag: the surface is not smooth across the edge (mark_sharp_edges), so lines do not continue there.
constexpr std::uint32_t k_sharp_side = 1u << 31;
/// Flag, besides k_sharp_side: more than two faces have the edge, and the widest empty angle around it is between
/// this face and the other. Seen from the edge all faces are between these two.
constexpr std::uint32_t k_crowded_side = 1u << 30;
constexpr std::uint32_t k_max_neighbor_code = k_crowded_side - 1;  ///< maximum value of 4 * face + side

/// Returns whether another face is across a side.
constexpr bool has_neighbor(std::uint32_t across) {
    return across < k_blocked_side;
}
/// Returns 4 * face + side of the face across, if there is one.
constexpr std::uint32_t neighbor_code(std::uint32_t across) {
    return across & k_max_neighbor_code;
}
/// Returns the face across, if there is one.
constexpr std::uint32_t neighbor_face(std::uint32_t across) {
    return neighbor_code(across) / 4;
}
/// Returns whether a side stands for its edge, which the face across has, too: that of the smaller code does.
constexpr bool owns_edge(std::uint32_t face, std::uint32_t side, std::uint32_t across) {
    return 4 * face + side < neighbor_code(across);
}

/// Returns whether both faces at an edge are oriented alike, so that they run along it in opposite directions.
/// `across`: of the side of `face`; `faces`: as they were before a surface was cut open.
inline bool oriented_alike(std::span<const Face> faces, std::uint32_t face, std::uint32_t side, std::uint32_t across) {
    return faces[face][side] != faces[neighbor_face(across)][neighbor_code(across) % 4];
}

/// Finds the neighbors of all faces in O(F log F). No edge is marked as sharp but those of more than two faces.
/// Throws MeshError if a face has a vertex that does not exist, or there are more faces than can be numbered (2^28).
std::vector<FaceNeighbors> build_face_neighbors(std::span<const Face> faces, std::span<const Vec3> vertices);

}  // namespace exemplar
