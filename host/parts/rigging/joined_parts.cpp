#include "host/parts/rigging/joined_parts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "host/core/interrupt.h"
#include "host/graphcut/max_flow.h"
#include "host/mesh/queries/distance_queue.h"
#include "host/parts/rigging/part_boundaries.h"

namespace exemplar {
namespace {

constexpr double k_unlimited = 1e30;
/// A half is a limb if the boundary at its end is longer than this times the square root of its area.
constexpr double k_limb_ratio = 0.7;

/// The faces of one part as nodes of a flow network, with the length of edges as capacity.
class PartFlow {
  public:
    PartFlow(const TriangleMesh& mesh, const Topology& topology, std::span<const std::uint32_t> part_of_face,
             std::uint32_t part) {
        std::vector<std::uint32_t> node_of(mesh.face_count(), k_invalid_index);
        for (std::uint32_t f = 0; f < mesh.face_count(); ++f)
            if (part_of_face[f] == part) {
                node_of[f] = static_cast<std::uint32_t>(faces_.size());
                faces_.push_back(f);
            }
        touching_.resize(faces_.size());
        for (const Edge& edge : topology.edges) {
            if (edge.is_boundary()) continue;
            const auto [a, b] = edge.face;
            if (part_of_face[a] == part && part_of_face[b] == part) {
                edges_.push_back({node_of[a], node_of[b]});
                steps_.push_back(dual_step(mesh, edge));
                lengths_.push_back((mesh.vertices[edge.vertex[0]] - mesh.vertices[edge.vertex[1]]).norm());
            } else if (part_of_face[a] == part) {
                touching_[node_of[a]].push_back(part_of_face[b]);
            } else if (part_of_face[b] == part) {
                touching_[node_of[b]].push_back(part_of_face[a]);
            }
        }
    }

    /// Finds the shortest cut halfway between the neighbor `one` and `other`. Returns its length, and the faces on the
    /// side of `one`.
    std::pair<double, std::vector<std::uint32_t>> cut(std::uint32_t one, std::uint32_t other) const {
        const std::vector<float> near = distances(one), far = distances(other);
        MaxFlow flow(faces_.size(), edges_);
        std::vector<double> capacity(flow.arcs(), 0), terminal(faces_.size(), 0);
        for (std::size_t e = 0; e < edges_.size(); ++e)
            for (const MaxFlow::ArcIndex arc : flow.arcs_of_edge(e)) capacity[arc] = lengths_[e];
        std::vector<MaxFlow::Node> start;
        for (std::uint32_t n = 0; n < faces_.size(); ++n) {
            if (2 * near[n] <= far[n]) start.push_back(n);
            terminal[n] = 2 * near[n] <= far[n] ? -k_unlimited : 2 * far[n] <= near[n] ? k_unlimited : 0;
        }
        flow.solve(start, [&](MaxFlow::Node n) {
            flow.set_node(n, terminal[n]);
            for (MaxFlow::ArcIndex arc = flow.first_arc(n); arc < flow.first_arc(n + 1); ++arc)
                flow.set_arc(arc, capacity[arc]);
        });
        std::pair<double, std::vector<std::uint32_t>> result{0, {}};
        for (std::uint32_t n = 0; n < faces_.size(); ++n)
            if (flow.on_sink_side(n)) result.second.push_back(faces_[n]);
        for (std::size_t e = 0; e < edges_.size(); ++e)
            if (flow.on_sink_side(edges_[e][0]) != flow.on_sink_side(edges_[e][1])) result.first += lengths_[e];
        return result;
    }

  private:
    static float dual_step(const TriangleMesh& mesh, const Edge& edge) {
        const Vec3 middle = (mesh.vertices[edge.vertex[0]] + mesh.vertices[edge.vertex[1]]) / 2;
        const auto to_center = [&](std::uint32_t f) {
            const Face& face = mesh.faces[f];
            return ((mesh.vertices[face[0]] + mesh.vertices[face[1]] + mesh.vertices[face[2]]) / 3 - middle).norm();
        };
        return to_center(edge.face[0]) + to_center(edge.face[1]);
    }

    /// Distances within the part from its boundary with a neighbor; infinity where it is not reached.
    std::vector<float> distances(std::uint32_t neighbor) const {
        std::vector<std::vector<std::size_t>> edges_of(faces_.size());
        for (std::size_t e = 0; e < edges_.size(); ++e)
            for (const MaxFlow::Node n : edges_[e]) edges_of[n].push_back(e);
        std::vector<float> distance(faces_.size(), std::numeric_limits<float>::infinity());
        DistanceQueue queue;
        for (std::uint32_t n = 0; n < faces_.size(); ++n)
            if (std::find(touching_[n].begin(), touching_[n].end(), neighbor) != touching_[n].end()) {
                distance[n] = 0;
                queue.push(0, n);
            }
        while (!queue.empty()) {
            const auto [reached, node] = queue.pop();
            if (reached > distance[node]) continue;
            for (const std::size_t e : edges_of[node]) {
                const MaxFlow::Node next = edges_[e][edges_[e][0] == node ? 1 : 0];
                if (reached + steps_[e] >= distance[next]) continue;
                distance[next] = reached + steps_[e];
                queue.push(distance[next], next);
            }
        }
        return distance;
    }

  private:
    std::vector<std::uint32_t> faces_;
    std::vector<std::vector<std::uint32_t>> touching_;  ///< per node: the other parts at its edges
    std::vector<std::array<MaxFlow::Node, 2>> edges_;
    std::vector<double> lengths_;  ///< of the edges between two faces
    std::vector<float> steps_;     ///< from center to center over them
};

/// The neighbors of each part by their label, with the length of the boundary.
using NeighborsByLabel = std::map<std::int32_t, std::map<std::uint32_t, double>>;

std::vector<NeighborsByLabel> neighbors_by_label(const TriangleMesh& mesh, const Topology& topology,
                                                 const std::vector<std::int32_t>& label_of_part,
                                                 const std::vector<std::uint32_t>& part_of_face) {
    std::vector<NeighborsByLabel> neighbors(label_of_part.size());
    for (const auto& [pair, length] : common_lengths(mesh, topology, part_of_face)) {
        neighbors[pair.first][label_of_part[pair.second]][pair.second] = length;
        neighbors[pair.second][label_of_part[pair.first]][pair.first] = length;
    }
    return neighbors;
}

double area_of(const TriangleMesh& mesh, const std::vector<std::uint32_t>& faces) {
    double area = 0;
    for (const std::uint32_t f : faces) {
        const Face& face = mesh.faces[f];
        const Vec3 a = mesh.vertices[face[1]] - mesh.vertices[face[0]],
                   b = mesh.vertices[face[2]] - mesh.vertices[face[0]];
        area += a.cross(b).norm() / 2;
    }
    return area;
}

/// The pair of neighbors of one label, if no other label has several; both boundaries are about as long.
std::optional<std::array<std::pair<std::uint32_t, double>, 2>> only_pair(const NeighborsByLabel& neighbors,
                                                                         std::int32_t own_label) {
    std::optional<std::array<std::pair<std::uint32_t, double>, 2>> pair;
    for (const auto& [label, alike] : neighbors) {
        if (alike.size() < 2 || label == own_label) continue;
        if (pair || alike.size() > 2) return {};
        pair = {*alike.begin(), *alike.rbegin()};
    }
    if (pair && std::min((*pair)[0].second, (*pair)[1].second) < std::max((*pair)[0].second, (*pair)[1].second) / 2)
        return {};
    return pair;
}

/// Returns the faces of the part on one side of a cut that divides it into two things, else nothing.
std::vector<std::uint32_t> joined_half(const TriangleMesh& mesh, const Topology& topology, std::uint32_t part,
                                       const NeighborsByLabel& neighbors, std::int32_t label,
                                       const std::vector<std::uint32_t>& part_of_face) {
    const auto pair = only_pair(neighbors, label);
    if (!pair) return {};
    check_interrupt();
    auto [length, side] = PartFlow(mesh, topology, part_of_face, part).cut((*pair)[0].first, (*pair)[1].first);
    const double boundary = ((*pair)[0].second + (*pair)[1].second) / 2;
    const bool is_short = length < k_joined_cut_ratio * boundary;
    const bool is_limb = boundary > k_limb_ratio * std::sqrt(area_of(mesh, side));
    return is_short && is_limb ? side : std::vector<std::uint32_t>();
}

}  // namespace

void divide_joined_parts(const TriangleMesh& mesh, const Topology& topology, std::vector<std::int32_t>& label_of_part,
                         std::vector<std::uint32_t>& part_of_face) {
    // By the neighbors before any division, so that one division does not lead to the next.
    const auto neighbors = neighbors_by_label(mesh, topology, label_of_part, part_of_face);
    for (std::uint32_t part = 0; part < neighbors.size(); ++part) {
        const auto half = joined_half(mesh, topology, part, neighbors[part], label_of_part[part], part_of_face);
        if (half.empty()) continue;
        for (const std::uint32_t f : half) part_of_face[f] = static_cast<std::uint32_t>(label_of_part.size());
        label_of_part.push_back(label_of_part[part]);
    }
}

}  // namespace exemplar
