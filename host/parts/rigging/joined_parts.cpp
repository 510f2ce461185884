#include "host/parts/rigging/joined_parts.h"

#include <algorithm>
#include <map>

#include "host/core/interrupt.h"
#include "host/graphcut/max_flow.h"
#include "host/parts/rigging/part_boundaries.h"

namespace exemplar {
namespace {

constexpr double k_unlimited = 1e30;

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
                lengths_.push_back((mesh.vertices[edge.vertex[0]] - mesh.vertices[edge.vertex[1]]).norm());
            } else if (part_of_face[a] == part) {
                touching_[node_of[a]].push_back(part_of_face[b]);
            } else if (part_of_face[b] == part) {
                touching_[node_of[b]].push_back(part_of_face[a]);
            }
        }
    }

    /// Finds the shortest cut between the neighbor `one` and those of `others`. Returns its length, and the faces on
    /// the side of `one`.
    std::pair<double, std::vector<std::uint32_t>> cut(std::uint32_t one,
                                                      const std::vector<std::uint32_t>& others) const {
        MaxFlow flow(faces_.size(), edges_);
        std::vector<double> capacity(flow.arcs(), 0);
        for (std::size_t e = 0; e < edges_.size(); ++e)
            for (const MaxFlow::ArcIndex arc : flow.arcs_of_edge(e)) capacity[arc] = lengths_[e];
        std::vector<MaxFlow::Node> start;
        std::vector<double> terminal(faces_.size(), 0);
        for (std::uint32_t n = 0; n < faces_.size(); ++n)
            for (const std::uint32_t neighbor : touching_[n]) {
                if (neighbor == one) start.push_back(n);
                if (neighbor == one) terminal[n] = -k_unlimited;
                if (std::find(others.begin(), others.end(), neighbor) != others.end()) terminal[n] = k_unlimited;
            }
        flow.solve(start, [&](MaxFlow::Node n) {
            flow.set_node(n, terminal[n]);
            for (MaxFlow::ArcIndex arc = flow.first_arc(n); arc < flow.first_arc(n + 1); ++arc)
                flow.set_arc(arc, capacity[arc]);
        });
        std::vector<std::uint32_t> side;
        double length = 0;
        for (std::uint32_t n = 0; n < faces_.size(); ++n)
            if (flow.on_sink_side(n)) side.push_back(faces_[n]);
        for (std::size_t e = 0; e < edges_.size(); ++e)
            if (flow.on_sink_side(edges_[e][0]) != flow.on_sink_side(edges_[e][1])) length += lengths_[e];
        return {length, side};
    }

  private:
    std::vector<std::uint32_t> faces_;
    std::vector<std::vector<std::uint32_t>> touching_;  ///< per node: the other parts at its edges
    std::vector<std::array<MaxFlow::Node, 2>> edges_;
    std::vector<double> lengths_;
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

/// Cuts off the piece of `part` at one of its neighbors of equal label, if it is joined to the rest by little. Returns
/// the faces of the piece.
std::vector<std::uint32_t> joined_piece(const PartFlow& flow, const std::map<std::uint32_t, double>& neighbors) {
    double longest = 0;
    for (const auto& [neighbor, length] : neighbors) longest = std::max(longest, length);
    std::vector<std::uint32_t> candidates;
    for (const auto& [neighbor, length] : neighbors)
        if (length > longest / 2) candidates.push_back(neighbor);
    for (std::size_t i = 0; i + 1 < candidates.size(); ++i) {
        check_interrupt();
        std::vector<std::uint32_t> others = candidates;
        others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
        const auto [length, side] = flow.cut(candidates[i], others);
        if (length < k_joined_cut_share * neighbors.at(candidates[i]) && !side.empty()) return side;
    }
    return {};
}

/// Divides the first part that can be divided; returns whether there was one.
bool divide_one(const TriangleMesh& mesh, const Topology& topology, std::vector<std::int32_t>& label_of_part,
                std::vector<std::uint32_t>& part_of_face) {
    const auto neighbors = neighbors_by_label(mesh, topology, label_of_part, part_of_face);
    for (std::uint32_t part = 0; part < neighbors.size(); ++part)
        for (const auto& [label, alike] : neighbors[part]) {
            if (alike.size() < 2 || label == label_of_part[part]) continue;
            const auto piece = joined_piece(PartFlow(mesh, topology, part_of_face, part), alike);
            if (piece.empty()) continue;
            for (const std::uint32_t f : piece) part_of_face[f] = static_cast<std::uint32_t>(label_of_part.size());
            label_of_part.push_back(label_of_part[part]);
            return true;
        }
    return false;
}

}  // namespace

void divide_joined_parts(const TriangleMesh& mesh, const Topology& topology, std::vector<std::int32_t>& label_of_part,
                         std::vector<std::uint32_t>& part_of_face) {
    const std::size_t most = 2 * label_of_part.size() + 16;
    while (label_of_part.size() < most && divide_one(mesh, topology, label_of_part, part_of_face)) {
    }
}

}  // namespace exemplar
