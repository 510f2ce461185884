#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "host/mesh/mesh.h"
#include "host/mesh/topology.h"

namespace exemplar {

/// The directed sides of the triangles of a mesh. Half-edge 3 f + i leads from corner i of face f to its next corner.
struct HalfEdges {
    /// Per half-edge the opposite one in the neighboring face; k_invalid_index on a boundary, on an edge of more than
    /// two faces, and where both faces traverse the edge in the same direction.
    std::vector<std::uint32_t> twin;
    /// Pairs of half-edges on edges of two or more faces that have no twin: non-manifold or inconsistently oriented.
    std::vector<std::array<std::uint32_t, 2>> irregular;
};

constexpr std::uint32_t face_of_half_edge(std::uint32_t half_edge) {
    return half_edge / 3;
}
/// Returns the half-edge after `half_edge` in its face.
constexpr std::uint32_t next_half_edge(std::uint32_t half_edge) {
    return half_edge % 3 == 2 ? half_edge - 2 : half_edge + 1;
}
inline std::uint32_t half_edge_start(const TriangleMesh& mesh, std::uint32_t half_edge) {
    return mesh.faces[half_edge / 3][half_edge % 3];
}
inline std::uint32_t half_edge_end(const TriangleMesh& mesh, std::uint32_t half_edge) {
    return half_edge_start(mesh, next_half_edge(half_edge));
}

/// Finds the twins of all half-edges, in O(F log F).
HalfEdges build_half_edges(const TriangleMesh& mesh);

}  // namespace exemplar
