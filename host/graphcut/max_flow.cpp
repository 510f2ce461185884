#include "host/graphcut/max_flow.h"

#include <algorithm>
#include <limits>
#include <string>

#include "host/core/errors.h"

namespace exemplar {
namespace {

// Marks in place of a parent's arc.
constexpr std::uint32_t k_root = 0xffffffffu;    // the sink itself is the parent
constexpr std::uint32_t k_orphan = 0xfffffffeu;  // the arc to the parent is saturated
constexpr std::uint32_t k_no_arc = 0xfffffffdu;
constexpr std::uint32_t k_unreachable = 0xffffffffu;  // a distance

bool is_arc(std::uint32_t parent) {
    return parent < k_no_arc;
}

}  // namespace

MaxFlow::MaxFlow(std::size_t nodes, std::span<const std::array<Node, 2>> edges)
    : vertices_(nodes + 1), arc_of_edge_(edges.size(), k_no_arc) {
    for (std::size_t e = 0; e < edges.size(); ++e) {
        const auto [a, b] = edges[e];
        if (a >= nodes || b >= nodes) {
            throw UsageError("edge " + std::to_string(e) + " joins nodes " + std::to_string(a) + " and " +
                             std::to_string(b) + ", but there are " + std::to_string(nodes));
        }
        if (a != b) ++vertices_[a + 1].first, ++vertices_[b + 1].first;
    }
    std::vector<ArcIndex> next(nodes);
    for (std::size_t i = 0; i < nodes; ++i) {
        next[i] = vertices_[i].first;
        vertices_[i + 1].first += vertices_[i].first;
    }
    arcs_.resize(vertices_[nodes].first);
    for (std::size_t e = 0; e < edges.size(); ++e) {
        const auto [a, b] = edges[e];
        if (a == b) continue;
        const ArcIndex forward = next[a]++, backward = next[b]++;
        arcs_[forward] = {b, backward, 0.0};
        arcs_[backward] = {a, forward, 0.0};
        arc_of_edge_[e] = forward;
    }
}

std::array<MaxFlow::ArcIndex, 2> MaxFlow::arcs_of_edge(std::size_t edge) const {
    const ArcIndex arc = arc_of_edge_[edge];
    return {arc, arc == k_no_arc ? arc : arcs_[arc].sister};
}

void MaxFlow::start_problem() {
    if (++problem_ == 0) {  // all numbers have been used
        for (Vertex& vertex : vertices_) vertex.problem = 0;
        problem_ = 1;
    }
    time_ = 0;
    reached_.clear();
    active_.clear();
    next_active_ = 0;
}

void MaxFlow::solve(std::span<const Node> start, const std::function<void(Node)>& reach_node) {
    start_problem();
    reach_ = &reach_node;
    for (const Node node : start) reach(node);
    for (ArcIndex meeting = find_meeting_arc(); meeting != k_no_arc; meeting = find_meeting_arc()) {
        ++time_;
        augment(meeting);
        adopt_orphans();
    }
}

/// Makes a node part of the problem, if it is not; a node with capacity to the sink becomes a root of the tree.
void MaxFlow::reach(Node node) {
    Vertex& vertex = vertices_[node];
    if (vertex.problem == problem_) return;
    vertex.problem = problem_;
    (*reach_)(node);
    reached_.push_back(node);
    vertex.stamp = 0;
    vertex.distance = 1;
    vertex.is_active = false;
    vertex.is_in_tree = vertex.terminal < 0.0;
    vertex.parent = vertex.is_in_tree ? k_root : k_no_arc;
    if (vertex.is_in_tree) activate(node);
}

void MaxFlow::activate(Node node) {
    if (vertices_[node].is_active) return;
    vertices_[node].is_active = true;
    active_.push_back(node);
}

/// Grows the tree from its active nodes until it touches a node that the source can reach directly; returns the arc
/// from that node into the tree.
MaxFlow::ArcIndex MaxFlow::find_meeting_arc() {
    while (next_active_ < active_.size()) {
        const Node node = active_[next_active_];
        if (vertices_[node].is_in_tree) {
            const ArcIndex meeting = scan(node);
            if (meeting != k_no_arc) return meeting;  // the node stays active: it may touch elsewhere too
        }
        vertices_[node].is_active = false;
        if (++next_active_ > nodes()) {
            active_.erase(active_.begin(), active_.begin() + static_cast<std::ptrdiff_t>(next_active_));
            next_active_ = 0;
        }
    }
    return k_no_arc;
}

MaxFlow::ArcIndex MaxFlow::scan(Node node) {
    const Vertex& vertex = vertices_[node];
    for (ArcIndex a = vertex.first; a < vertices_[node + 1].first; ++a) {
        const Node other = arcs_[a].head;
        reach(other);
        const ArcIndex to_parent = arcs_[a].sister;  // from the neighbor, if this node becomes its parent
        if (arcs_[to_parent].residual <= 0.0) continue;
        Vertex& neighbor = vertices_[other];
        if (neighbor.terminal > 0.0) return to_parent;
        if (!neighbor.is_in_tree) {
            neighbor.is_in_tree = true;
            activate(other);
        } else if (neighbor.stamp > vertex.stamp || neighbor.distance <= vertex.distance) {
            continue;
        }  // else: this node gives a shorter path to the root to one that is in the tree
        neighbor.parent = to_parent;
        neighbor.stamp = vertex.stamp;
        neighbor.distance = vertex.distance + 1;
    }
    return k_no_arc;
}

double MaxFlow::bottleneck(ArcIndex meeting) const {
    double least = std::min(arcs_[meeting].residual, vertices_[arcs_[arcs_[meeting].sister].head].terminal);
    Node node = arcs_[meeting].head;
    for (; is_arc(vertices_[node].parent); node = arcs_[vertices_[node].parent].head)
        least = std::min(least, arcs_[vertices_[node].parent].residual);
    return std::min(least, -vertices_[node].terminal);
}

/// Sends as much flow as the path carries from the source over the meeting arc and up the tree.
void MaxFlow::augment(ArcIndex meeting) {
    const double flow = bottleneck(meeting);
    vertices_[arcs_[arcs_[meeting].sister].head].terminal -= flow;
    arcs_[meeting].residual -= flow;
    arcs_[arcs_[meeting].sister].residual += flow;
    Node node = arcs_[meeting].head;
    while (is_arc(vertices_[node].parent)) {
        Arc& arc = arcs_[vertices_[node].parent];
        arc.residual -= flow;
        arcs_[arc.sister].residual += flow;
        if (arc.residual <= 0.0) make_orphan(node);
        node = arc.head;
    }
    vertices_[node].terminal += flow;
    if (vertices_[node].terminal == 0.0) make_orphan(node);
}

void MaxFlow::make_orphan(Node node) {
    vertices_[node].parent = k_orphan;
    orphans_.push_back(node);
}

void MaxFlow::adopt_orphans() {
    for (std::size_t i = 0; i < orphans_.size(); ++i) {  // grows meanwhile
        const Node orphan = orphans_[i];
        const ArcIndex to_parent = find_parent(orphan);
        if (to_parent == k_no_arc) {
            set_free(orphan);
        } else {
            vertices_[orphan].parent = to_parent;
        }
    }
    orphans_.clear();
}

/// Returns the arc to the neighbor in the tree that is nearest to the root; k_no_arc if none is connected to it.
MaxFlow::ArcIndex MaxFlow::find_parent(Node orphan) {
    ArcIndex best = k_no_arc;
    std::uint32_t least = k_unreachable;
    for (ArcIndex a = vertices_[orphan].first; a < vertices_[orphan + 1].first; ++a) {
        const Node other = arcs_[a].head;
        if (arcs_[a].residual <= 0.0 || !on_sink_side(other)) continue;
        const std::uint32_t distance = distance_to_root(other);
        if (distance < least) least = distance, best = a;
    }
    if (best != k_no_arc) vertices_[orphan].stamp = time_, vertices_[orphan].distance = least + 1;
    return best;
}

std::uint32_t MaxFlow::distance_to_root(Node node) {
    std::uint32_t distance = 0;
    for (Node i = node;; i = arcs_[vertices_[i].parent].head) {
        Vertex& vertex = vertices_[i];
        if (vertex.stamp == time_) {
            distance += vertex.distance;
            break;
        }
        if (vertex.parent == k_orphan) return k_unreachable;
        ++distance;
        if (vertex.parent == k_root) {
            vertex.stamp = time_;
            vertex.distance = 1;
            break;
        }
    }
    std::uint32_t left = distance;
    for (Node i = node; vertices_[i].stamp != time_; i = arcs_[vertices_[i].parent].head) {
        vertices_[i].stamp = time_;
        vertices_[i].distance = left--;
    }
    return distance;
}

void MaxFlow::set_free(Node orphan) {
    for (ArcIndex a = vertices_[orphan].first; a < vertices_[orphan + 1].first; ++a) {
        const Node other = arcs_[a].head;
        if (!on_sink_side(other)) continue;
        if (arcs_[a].residual > 0.0) activate(other);  // it can grow back to here
        const ArcIndex parent = vertices_[other].parent;
        if (is_arc(parent) && arcs_[parent].head == orphan) make_orphan(other);
    }
    vertices_[orphan].is_in_tree = false;
    vertices_[orphan].parent = k_no_arc;
}

}  // namespace exemplar
