#include "host/parts/rigging/part_boundaries.h"

#include <algorithm>

namespace exemplar {
namespace {

/// The length and the length-weighted sum of positions of a connected boundary.
struct BoundaryLoop {
    double length = 0;
    Vec3d moment = Vec3d::Zero();
};

double edge_length(const TriangleMesh& mesh, const Edge& edge) {
    return (mesh.vertices[edge.vertex[0]] - mesh.vertices[edge.vertex[1]]).cast<double>().norm();
}

/// The edges between two parts, as connected loops or arcs.
std::vector<BoundaryLoop> boundary_loops(const TriangleMesh& mesh, const std::vector<const Edge*>& edges) {
    std::map<std::uint32_t, std::uint32_t> parent;
    const auto find = [&](std::uint32_t v) {
        while (parent[v] != v) v = parent[v] = parent[parent[v]];
        return v;
    };
    for (const Edge* edge : edges)
        for (const std::uint32_t v : edge->vertex) parent.emplace(v, v);
    for (const Edge* edge : edges) {
        const std::uint32_t a = find(edge->vertex[0]), b = find(edge->vertex[1]);
        parent[std::max(a, b)] = std::min(a, b);
    }
    std::map<std::uint32_t, BoundaryLoop> loops;
    for (const Edge* edge : edges) {
        BoundaryLoop& loop = loops[find(edge->vertex[0])];
        const double length = edge_length(mesh, *edge);
        loop.length += length;
        loop.moment += length / 2 * (mesh.vertices[edge->vertex[0]] + mesh.vertices[edge->vertex[1]]).cast<double>();
    }
    std::vector<BoundaryLoop> result;
    result.reserve(loops.size());
    for (const auto& [root, loop] : loops) result.push_back(loop);
    return result;
}

/// The corner of a face that is not on an edge.
const Vec3& third_corner(const TriangleMesh& mesh, std::uint32_t face, const Edge& edge) {
    for (const std::uint32_t v : mesh.faces[face])
        if (v != edge.vertex[0] && v != edge.vertex[1]) return mesh.vertices[v];
    return mesh.vertices[edge.vertex[0]];
}

/// 1 where an edge is flat or convex, 0 where its faces stand at a right angle or less, as where a hand touches the
/// hip.
double flatness(const TriangleMesh& mesh, const std::vector<Vec3>& normals, const Edge& edge) {
    const auto [f, g] = edge.face;
    const Vec3 across = third_corner(mesh, g, edge) - mesh.vertices[edge.vertex[0]];
    if (across.dot(normals[f]) <= 0) return 1;
    return std::max(0.0F, normals[f].dot(normals[g]));
}

PartBoundary boundary_between(const TriangleMesh& mesh, const std::vector<Vec3>& normals, const PartPair& pair,
                              const std::vector<const Edge*>& edges) {
    const std::vector<BoundaryLoop> loops = boundary_loops(mesh, edges);
    double longest = 0;
    for (const BoundaryLoop& loop : loops) longest = std::max(longest, loop.length);
    PartBoundary boundary{{pair.first, pair.second}, 0, 0, mesh.vertices[edges.front()->vertex[0]]};
    for (const Edge* edge : edges) boundary.strength += edge_length(mesh, *edge) * flatness(mesh, normals, *edge);
    double counted = 0;
    Vec3d moment = Vec3d::Zero();
    for (const BoundaryLoop& loop : loops) {
        boundary.length += loop.length;
        if (loop.length < longest / 2) continue;
        counted += loop.length;
        moment += loop.moment;
    }
    if (counted > 0) boundary.center = (moment / counted).cast<float>();
    return boundary;
}

std::map<PartPair, std::vector<const Edge*>> edges_between(const Topology& topology,
                                                           std::span<const std::uint32_t> part_of_face) {
    std::map<PartPair, std::vector<const Edge*>> edges;
    for (const Edge& edge : topology.edges) {
        if (edge.is_boundary()) continue;
        const std::uint32_t a = part_of_face[edge.face[0]], b = part_of_face[edge.face[1]];
        if (a != b) edges[{std::min(a, b), std::max(a, b)}].push_back(&edge);
    }
    return edges;
}

}  // namespace

std::map<PartPair, double> common_lengths(const TriangleMesh& mesh, const Topology& topology,
                                          std::span<const std::uint32_t> part_of_face) {
    std::map<PartPair, double> lengths;
    for (const auto& [pair, edges] : edges_between(topology, part_of_face))
        for (const Edge* edge : edges) lengths[pair] += edge_length(mesh, *edge);
    return lengths;
}

std::vector<PartBoundary> part_boundaries(const TriangleMesh& mesh, const Topology& topology,
                                          std::span<const std::uint32_t> part_of_face,
                                          std::span<const PartBoundary> contacts) {
    std::map<PartPair, PartBoundary> found;
    for (const PartBoundary& contact : contacts) found.emplace(PartPair(contact.part[0], contact.part[1]), contact);
    const std::vector<Vec3> normals = face_normals(mesh);
    for (const auto& [pair, edges] : edges_between(topology, part_of_face))
        found[pair] = boundary_between(mesh, normals, pair, edges);
    std::vector<PartBoundary> boundaries;
    boundaries.reserve(found.size());
    for (const auto& [pair, boundary] : found) boundaries.push_back(boundary);
    return boundaries;
}

}  // namespace exemplar
