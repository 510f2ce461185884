#include "host/parts/splitting/part_check.h"

#include <Eigen/Geometry>

#include "host/core/disjoint_sets.h"
#include "host/parts/splitting/half_edges.h"

namespace exemplar {
namespace {

/// Counts the vertices whose corners fall into more than one fan of faces.
std::size_t count_split_vertices(const TriangleMesh& mesh, const HalfEdges& edges) {
    DisjointSets fans(edges.twin.size());
    for (std::uint32_t h = 0; h < edges.twin.size(); ++h) {
        if (edges.twin[h] == k_invalid_index) continue;
        fans.join(h, next_half_edge(edges.twin[h]));
        fans.join(next_half_edge(h), edges.twin[h]);
    }
    std::vector<std::uint32_t> fan(mesh.vertex_count(), k_invalid_index);
    std::vector<bool> is_split(mesh.vertex_count(), false);
    for (std::uint32_t h = 0; h < edges.twin.size(); ++h) {
        const std::uint32_t v = half_edge_start(mesh, h);
        if (fan[v] == k_invalid_index) fan[v] = fans.find(h);
        if (fan[v] != fans.find(h)) is_split[v] = true;
    }
    std::size_t count = 0;
    for (const bool split : is_split) count += split ? 1 : 0;
    return count;
}

}  // namespace

double signed_volume_about(const TriangleMesh& mesh, const Vec3d& center) {
    double sum = 0;
    for (const auto& [a, b, c] : mesh.faces)
        sum += (mesh.vertices[a].cast<double>() - center)
                   .cross(mesh.vertices[b].cast<double>() - center)
                   .dot(mesh.vertices[c].cast<double>() - center);
    return sum / 6;
}

PartCheck check_part(const TriangleMesh& mesh) {
    PartCheck check;
    if (mesh.faces.empty()) return check;
    const HalfEdges edges = build_half_edges(mesh);
    std::vector<bool> is_irregular(edges.twin.size(), false);
    for (const auto& [a, b] : edges.irregular) is_irregular[a] = is_irregular[b] = true;
    for (std::uint32_t h = 0; h < edges.twin.size(); ++h)
        if (edges.twin[h] == k_invalid_index && !is_irregular[h]) ++check.boundary_edges;
    for (std::size_t i = 0; i < edges.irregular.size(); ++i)
        if (i == 0 || edges.irregular[i][0] != edges.irregular[i - 1][0]) ++check.irregular_edges;
    check.split_vertices = count_split_vertices(mesh, edges);
    const BoundingBox box = bounding_box(mesh);
    check.volume = signed_volume_about(mesh, (box.low + box.high) / 2);
    return check;
}

}  // namespace exemplar
