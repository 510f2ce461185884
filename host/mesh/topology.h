#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "host/mesh/mesh.h"

namespace exemplar {

constexpr std::uint32_t k_invalid_index = std::numeric_limits<std::uint32_t>::max();

/// An undirected edge, vertex[0] < vertex[1]. face[1] is k_invalid_index on a boundary.
/// A non-manifold edge (more than two faces) gives one Edge per consecutive pair of its faces (a chain), so that
/// neighbors stay connected and every Edge still has at most two faces.
struct Edge {
    std::array<std::uint32_t, 2> vertex;
    std::array<std::uint32_t, 2> face;
    bool is_boundary() const { return face[1] == k_invalid_index; }
};

/// Edge, face and vertex incidence of a mesh. Built once in O(F log F); edges are sorted by their vertices.
struct Topology {
    std::vector<Edge> edges;
    /// Compressed rows: the edges around face f are face_edges[face_edge_begin[f] .. face_edge_begin[f + 1]).
    std::vector<std::uint32_t> face_edge_begin, face_edges;
    /// Compressed rows: the faces around vertex v, in increasing order.
    std::vector<std::uint32_t> vertex_face_begin, vertex_faces;

    std::span<const std::uint32_t> edges_of_face(std::uint32_t f) const {
        return {face_edges.data() + face_edge_begin[f], face_edges.data() + face_edge_begin[f + 1]};
    }
    std::span<const std::uint32_t> faces_of_vertex(std::uint32_t v) const {
        return {vertex_faces.data() + vertex_face_begin[v], vertex_faces.data() + vertex_face_begin[v + 1]};
    }
};

/// Builds the incidence of a mesh. A face that names a vertex twice contributes only its proper edges.
Topology build_topology(const TriangleMesh& mesh);

/// Returns the connected component of each face (faces that share an edge), numbered from 0 in order of first face.
std::vector<std::uint32_t> face_components(const TriangleMesh& mesh, const Topology& topology);

/// Returns the exterior dihedral angle of each edge in radians, in [0, 2 pi]: the angle between its two faces
/// measured outside the surface (the omega of thesis Eq. 3.4). Flat is pi, a convex edge of a cube 3 pi / 2, a
/// concave one pi / 2. Boundary edges and edges with a degenerate face have pi.
std::vector<float> exterior_dihedral_angles(const TriangleMesh& mesh, const Topology& topology);

}  // namespace exemplar
