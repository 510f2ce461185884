#include "host/labeling/evaluation/cut_discrepancy.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "host/core/errors.h"
#include "host/mesh/queries/distance_queue.h"
#include "host/mesh/topology.h"

namespace exemplar {
namespace {

/// Returns the mean distance of the surface's points from its centroid; of the face centers if no face has area.
double mean_radius(const TriangleMesh& mesh) {
    const std::vector<float> areas = face_areas(mesh);
    const std::vector<Vec3> centers = face_centers(mesh);
    double largest = 0;
    for (const float area : areas) largest = std::max(largest, static_cast<double>(area));
    const auto weight = [&](std::size_t f) { return largest > 0 ? static_cast<double>(areas[f]) : 1.0; };
    Vec3d centroid = Vec3d::Zero();
    double total = 0, sum = 0;
    for (std::size_t f = 0; f < centers.size(); ++f) {
        centroid += weight(f) * centers[f].cast<double>();
        total += weight(f);
    }
    centroid /= total;
    for (std::size_t f = 0; f < centers.size(); ++f) sum += weight(f) * (centers[f].cast<double>() - centroid).norm();
    return sum / total;
}

/// Calls visit(a, b) for each pair of nodes with a straight path between them on the surface: an end and the midpoint
/// of an edge, the midpoints of two edges of a face, a corner of a face and the midpoint of the opposite edge.
template <typename Visit>
void visit_links(const TriangleMesh& mesh, const Topology& topology, Visit&& visit) {
    const auto vertices = static_cast<std::uint32_t>(mesh.vertex_count());
    for (std::uint32_t e = 0; e < topology.edges.size(); ++e)
        for (const std::uint32_t vertex : topology.edges[e].vertex) visit(vertex, vertices + e);
    for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
        const std::span<const std::uint32_t> edges = topology.edges_of_face(f);
        for (std::size_t i = 0; i < edges.size(); ++i) {
            for (std::size_t j = 0; j < i; ++j) visit(vertices + edges[j], vertices + edges[i]);
            const auto& ends = topology.edges[edges[i]].vertex;
            for (const std::uint32_t corner : mesh.faces[f])
                if (corner != ends[0] && corner != ends[1]) visit(corner, vertices + edges[i]);
        }
    }
}

}  // namespace

CutDiscrepancy::CutDiscrepancy(const TriangleMesh& mesh)
    : face_count_(mesh.face_count()), mean_radius_(mean_radius(mesh)) {
    const Topology topology = build_topology(mesh);
    std::vector<Vec3> node = mesh.vertices;
    const auto vertices = static_cast<std::uint32_t>(node.size());
    for (const Edge& edge : topology.edges) {
        const Vec3 &a = mesh.vertices[edge.vertex[0]], &b = mesh.vertices[edge.vertex[1]];
        const auto midpoint = static_cast<std::uint32_t>(node.size());
        node.push_back((a + b) * 0.5F);
        if (!edge.is_boundary())
            edges_.push_back(
                {midpoint, {edge.vertex[0], edge.vertex[1]}, {edge.face[0], edge.face[1]}, (a - b).norm()});
    }
    link_begin_.assign(vertices + topology.edges.size() + 1, 0);
    visit_links(mesh, topology, [&](std::uint32_t a, std::uint32_t b) { ++link_begin_[a + 1], ++link_begin_[b + 1]; });
    for (std::size_t i = 1; i < link_begin_.size(); ++i) link_begin_[i] += link_begin_[i - 1];
    links_.resize(link_begin_.back());
    std::vector<std::uint32_t> next(link_begin_.begin(), link_begin_.end() - 1);
    visit_links(mesh, topology, [&](std::uint32_t a, std::uint32_t b) {
        const float length = (node[a] - node[b]).norm();
        links_[next[a]++] = {b, length};
        links_[next[b]++] = {a, length};
    });
}

std::vector<float> CutDiscrepancy::distances_to(const std::vector<std::uint32_t>& cuts) const {
    std::vector<float> distance(link_begin_.size() - 1, std::numeric_limits<float>::infinity());
    DistanceQueue queue;
    const auto relax = [&](std::uint32_t node, float candidate) {
        if (candidate >= distance[node]) return;
        distance[node] = candidate;
        queue.push(candidate, node);
    };
    for (const std::uint32_t cut : cuts)
        for (const std::uint32_t node : {edges_[cut].vertex[0], edges_[cut].vertex[1], edges_[cut].edge_node})
            relax(node, 0);
    while (!queue.empty()) {
        const auto [reached, node] = queue.pop();
        if (reached > distance[node]) continue;  // a shorter path has been found since
        for (std::uint32_t i = link_begin_[node]; i != link_begin_[node + 1]; ++i)
            relax(links_[i].node, reached + links_[i].length);
    }
    return distance;
}

SegmentCuts CutDiscrepancy::cuts_of(std::span<const std::int32_t> segments) const {
    if (segments.size() != face_count_)
        throw UsageError(
            fmt::format("a segmentation of {} faces is not one of a mesh of {} faces", segments.size(), face_count_));
    SegmentCuts cuts;
    for (std::uint32_t e = 0; e < edges_.size(); ++e)
        if (segments[edges_[e].face[0]] != segments[edges_[e].face[1]]) cuts.edge.push_back(e);
    cuts.distance = distances_to(cuts.edge);
    return cuts;
}

double CutDiscrepancy::mean_distance(const SegmentCuts& from, const SegmentCuts& to) const {
    const auto distance = [&](std::uint32_t node) {
        return std::isinf(to.distance[node]) ? mean_radius_ : static_cast<double>(to.distance[node]);
    };
    double sum = 0, total = 0;
    for (const std::uint32_t e : from.edge) {
        const CutEdge& edge = edges_[e];
        const double length = static_cast<double>(edge.length);  // the trapezoidal rule over both halves
        sum += length * (distance(edge.vertex[0]) + 2 * distance(edge.edge_node) + distance(edge.vertex[1])) / 4;
        total += length;
    }
    return sum / total;
}

double CutDiscrepancy::between(const SegmentCuts& a, const SegmentCuts& b) const {
    if (a.edge.empty() && b.edge.empty()) return 0;
    if (a.edge.empty() || b.edge.empty() || !(mean_radius_ > 0)) return std::numeric_limits<double>::quiet_NaN();
    return (mean_distance(a, b) + mean_distance(b, a)) / mean_radius_;
}

}  // namespace exemplar
