#include "host/mesh/editing/merge_coincident_faces.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "host/mesh/editing/remove_faces.h"
#include "host/mesh/topology.h"

namespace exemplar {
namespace {

constexpr double k_flat_cosine = 0.9397;  // of 20 degrees

std::size_t remove_copies(TriangleMesh& mesh) {
    std::vector<std::pair<Face, std::uint32_t>> by_corners(mesh.face_count());
    for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
        by_corners[f] = {mesh.faces[f], f};
        std::ranges::sort(by_corners[f].first);
    }
    std::ranges::sort(by_corners);
    std::vector<bool> is_removed(mesh.face_count());
    for (std::size_t i = 1; i < by_corners.size(); ++i)
        if (by_corners[i].first == by_corners[i - 1].first) is_removed[by_corners[i].second] = true;
    return remove_faces(mesh, is_removed);
}

std::uint32_t corner_opposite(const Face& face, const Edge& edge) {
    for (const std::uint32_t v : face)
        if (v != edge.vertex[0] && v != edge.vertex[1]) return v;
    return face[0];
}

/// Returns the cosine of the angle between two faces at their edge: 1 if one lies on the other, -1 if they are flat.
double cosine_at_edge(const TriangleMesh& mesh, const Edge& edge) {
    const Vec3d a = mesh.vertices[edge.vertex[0]].cast<double>();
    const Vec3d along = (mesh.vertices[edge.vertex[1]].cast<double>() - a).normalized();
    std::array<Vec3d, 2> across;
    for (std::size_t i = 0; i < 2; ++i) {
        const Vec3d to = mesh.vertices[corner_opposite(mesh.faces[edge.face[i]], edge)].cast<double>() - a;
        across[i] = (to - to.dot(along) * along).normalized();
    }
    return across[0].dot(across[1]);
}

bool edge_has_more_faces(const std::vector<Edge>& edges, std::size_t e) {
    return (e > 0 && edges[e - 1].vertex == edges[e].vertex) ||
           (e + 1 < edges.size() && edges[e + 1].vertex == edges[e].vertex);
}

/// Marks the faces with an edge at which another face may lie on them. There are few in an ordinary mesh.
std::vector<bool> folded_faces(const TriangleMesh& mesh, const Topology& topology) {
    std::vector<bool> is_folded(mesh.face_count());
    for (std::size_t e = 0; e < topology.edges.size(); ++e) {
        const Edge& edge = topology.edges[e];
        if (edge.is_boundary()) continue;
        if (!edge_has_more_faces(topology.edges, e) && cosine_at_edge(mesh, edge) < k_flat_cosine) continue;
        for (const std::uint32_t f : edge.face) is_folded[f] = true;
    }
    return is_folded;
}

/// Two faces that cut a nearly flat quad along a diagonal.
struct CutQuad {
    std::array<std::uint32_t, 4> corners;   ///< in increasing order
    std::array<std::uint32_t, 2> face;      ///< in increasing order
    std::array<std::uint32_t, 2> diagonal;  ///< in increasing order
    bool operator<(const CutQuad& other) const {
        return corners != other.corners ? corners < other.corners : face < other.face;
    }
};

std::optional<CutQuad> quad_across(const TriangleMesh& mesh, const Edge& edge) {
    const std::uint32_t c = corner_opposite(mesh.faces[edge.face[0]], edge),
                        d = corner_opposite(mesh.faces[edge.face[1]], edge);
    if (c == d || !(cosine_at_edge(mesh, edge) < -k_flat_cosine)) return std::nullopt;
    CutQuad quad{{edge.vertex[0], edge.vertex[1], c, d}, edge.face, edge.vertex};
    std::ranges::sort(quad.corners);
    std::ranges::sort(quad.face);
    return quad;
}

/// Returns whether two cuts of the same four corners are along both diagonals of a quad.
bool cross_each_other(const CutQuad& a, const CutQuad& b) {
    return a.corners == b.corners && a.diagonal[0] != b.diagonal[0] && a.diagonal[0] != b.diagonal[1] &&
           a.diagonal[1] != b.diagonal[0] && a.diagonal[1] != b.diagonal[1];
}

std::size_t remove_crossed_quads(TriangleMesh& mesh) {
    const Topology topology = build_topology(mesh);
    const std::vector<bool> is_folded = folded_faces(mesh, topology);
    std::vector<CutQuad> quads;
    for (std::size_t e = 0; e < topology.edges.size(); ++e) {
        const Edge& edge = topology.edges[e];
        if (edge.is_boundary() || edge_has_more_faces(topology.edges, e)) continue;
        if (!is_folded[edge.face[0]] || !is_folded[edge.face[1]]) continue;
        if (const auto quad = quad_across(mesh, edge)) quads.push_back(*quad);
    }
    std::ranges::sort(quads, [](const CutQuad& a, const CutQuad& b) { return a < b; });
    std::vector<bool> is_removed(mesh.face_count());
    const auto is_whole = [&](const CutQuad& quad) { return !is_removed[quad.face[0]] && !is_removed[quad.face[1]]; };
    for (std::size_t i = 1; i < quads.size(); ++i) {
        // Copies are gone, so that each diagonal of a quad is there once.
        if (!cross_each_other(quads[i - 1], quads[i]) || !is_whole(quads[i - 1]) || !is_whole(quads[i])) continue;
        for (const std::uint32_t f : quads[i].face) is_removed[f] = true;
    }
    return remove_faces(mesh, is_removed);
}

}  // namespace

std::size_t merge_coincident_faces(TriangleMesh& mesh) {
    const std::size_t copies = remove_copies(mesh);
    return copies + remove_crossed_quads(mesh);
}

}  // namespace exemplar
