#include "host/graphcut/max_flow.h"

#include <algorithm>
#include <limits>
#include <string>

#include "host/core/errors.h"

namespace exemplar {
namespace {

// Marks in place of a parent's arc.
constexpr std::uint32_t k_root = 0xffffffffu;    // the terminal itself is the parent
constexpr std::uint32_t k_orphan = 0xfffffffeu;  // the arc to the parent is saturated
constexpr std::uint32_t k_no_arc = 0xfffffffdu;
constexpr std::uint32_t k_unreachable = 0xffffffffu;  // a distance

bool is_arc(std::uint32_t parent) {
    return parent < k_no_arc;
}

}  // namespace

MaxFlow::MaxFlow(std::size_t nodes, std::span<const std::array<std::uint32_t, 2>> edges)
    : first_(nodes + 1, 0),
      arc_of_edge_(edges.size(), k_no_arc),
      terminal_(nodes, 0.0),
      tree_(nodes, Tree::none),
      parent_(nodes, k_no_arc),
      distance_(nodes, 0),
      stamp_(nodes, 0),
      is_active_(nodes, 0) {
    for (std::size_t e = 0; e < edges.size(); ++e) {
        const auto [a, b] = edges[e];
        if (a >= nodes || b >= nodes) {
            throw UsageError("edge " + std::to_string(e) + " joins nodes " + std::to_string(a) + " and " +
                             std::to_string(b) + ", but there are " + std::to_string(nodes));
        }
        if (a != b) ++first_[a + 1], ++first_[b + 1];
    }
    for (std::size_t i = 0; i < nodes; ++i) first_[i + 1] += first_[i];
    arcs_.resize(first_[nodes]);
    std::vector<ArcIndex> next(first_.begin(), first_.end() - 1);
    for (std::size_t e = 0; e < edges.size(); ++e) {
        const auto [a, b] = edges[e];
        if (a == b) continue;
        const ArcIndex forward = next[a]++, backward = next[b]++;
        arcs_[forward] = {b, backward, 0.0};
        arcs_[backward] = {a, forward, 0.0};
        arc_of_edge_[e] = forward;
    }
}

void MaxFlow::clear() {
    std::fill(terminal_.begin(), terminal_.end(), 0.0);
    for (Arc& arc : arcs_) arc.residual = 0.0;
    flow_ = 0.0;
}

void MaxFlow::add_terminals(std::size_t node, double from_source, double to_sink) {
    const double before = terminal_[node];
    const double in = from_source + std::max(before, 0.0), out = to_sink + std::max(-before, 0.0);
    flow_ += std::min(in, out);  // goes straight through
    terminal_[node] = in - out;
}

void MaxFlow::set_edge(std::size_t edge, double forward, double backward) {
    const ArcIndex arc = arc_of_edge_[edge];
    if (arc == k_no_arc) return;
    arcs_[arc].residual = forward;
    arcs_[arcs_[arc].sister].residual = backward;
}

double MaxFlow::solve() {
    plant_trees();
    for (ArcIndex meeting = find_meeting_arc(); meeting != k_no_arc; meeting = find_meeting_arc()) {
        ++time_;
        augment(meeting);
        adopt_orphans();
    }
    return flow_;
}

void MaxFlow::plant_trees() {
    active_.clear();
    orphans_.clear();
    next_active_ = 0;
    time_ = 0;
    for (Node i = 0; i < terminal_.size(); ++i) {
        stamp_[i] = 0;
        distance_[i] = 1;
        is_active_[i] = 0;
        tree_[i] = terminal_[i] > 0.0 ? Tree::source : terminal_[i] < 0.0 ? Tree::sink : Tree::none;
        parent_[i] = tree_[i] == Tree::none ? k_no_arc : k_root;
        if (tree_[i] != Tree::none) activate(i);
    }
}

void MaxFlow::activate(Node node) {
    if (is_active_[node]) return;
    is_active_[node] = 1;
    active_.push_back(node);
}

/// Grows the trees from their active nodes until they touch; returns the arc from the source's to the sink's tree.
MaxFlow::ArcIndex MaxFlow::find_meeting_arc() {
    while (next_active_ < active_.size()) {
        const Node node = active_[next_active_];
        if (tree_[node] != Tree::none) {
            const ArcIndex meeting = scan(node);
            if (meeting != k_no_arc) return meeting;  // the node stays active: it may touch elsewhere too
        }
        is_active_[node] = 0;
        if (++next_active_ > terminal_.size()) {
            active_.erase(active_.begin(), active_.begin() + static_cast<std::ptrdiff_t>(next_active_));
            next_active_ = 0;
        }
    }
    return k_no_arc;
}

MaxFlow::ArcIndex MaxFlow::scan(Node node) {
    const Tree tree = tree_[node];
    for (ArcIndex a = first_[node]; a < first_[node + 1]; ++a) {
        const ArcIndex to_parent = arcs_[a].sister;  // from the neighbor, if this node becomes its parent
        if (arcs_[along_flow(tree, to_parent)].residual <= 0.0) continue;
        const Node other = arcs_[a].head;
        if (tree_[other] == Tree::none) {
            tree_[other] = tree;
            activate(other);
        } else if (tree_[other] != tree) {
            return along_flow(tree, to_parent);
        } else if (stamp_[other] > stamp_[node] || distance_[other] <= distance_[node]) {
            continue;
        }  // else: this node is a shorter way to the root for one in its own tree
        parent_[other] = to_parent;
        stamp_[other] = stamp_[node];
        distance_[other] = distance_[node] + 1;
    }
    return k_no_arc;
}

double MaxFlow::bottleneck(ArcIndex meeting) const {
    double least = arcs_[meeting].residual;
    for (Node node : {arcs_[arcs_[meeting].sister].head, arcs_[meeting].head}) {
        for (; is_arc(parent_[node]); node = arcs_[parent_[node]].head) {
            least = std::min(least, arcs_[along_flow(tree_[node], parent_[node])].residual);
        }
        least = std::min(least, tree_[node] == Tree::source ? terminal_[node] : -terminal_[node]);
    }
    return least;
}

void MaxFlow::push_to_root(Node node, double flow) {
    while (is_arc(parent_[node])) {
        Arc& arc = arcs_[along_flow(tree_[node], parent_[node])];
        const Node above = arcs_[parent_[node]].head;
        arc.residual -= flow;
        arcs_[arc.sister].residual += flow;
        if (arc.residual <= 0.0) make_orphan(node);
        node = above;
    }
    terminal_[node] += tree_[node] == Tree::source ? -flow : flow;
    if (terminal_[node] == 0.0) make_orphan(node);
}

void MaxFlow::augment(ArcIndex meeting) {
    const double flow = bottleneck(meeting);
    Arc& arc = arcs_[meeting];
    arc.residual -= flow;
    arcs_[arc.sister].residual += flow;
    push_to_root(arcs_[arc.sister].head, flow);
    push_to_root(arc.head, flow);
    flow_ += flow;
}

void MaxFlow::make_orphan(Node node) {
    parent_[node] = k_orphan;
    orphans_.push_back(node);
}

void MaxFlow::adopt_orphans() {
    for (std::size_t i = 0; i < orphans_.size(); ++i) {  // grows meanwhile
        const Node orphan = orphans_[i];
        const ArcIndex to_parent = find_parent(orphan);
        if (to_parent == k_no_arc) {
            set_free(orphan);
        } else {
            parent_[orphan] = to_parent;
        }
    }
    orphans_.clear();
}

/// The arc to the neighbor in the same tree that is nearest to the root, and k_no_arc if none is connected to it.
MaxFlow::ArcIndex MaxFlow::find_parent(Node orphan) {
    const Tree tree = tree_[orphan];
    ArcIndex best = k_no_arc;
    std::uint32_t least = k_unreachable;
    for (ArcIndex a = first_[orphan]; a < first_[orphan + 1]; ++a) {
        const Node other = arcs_[a].head;
        if (tree_[other] != tree || arcs_[along_flow(tree, a)].residual <= 0.0) continue;
        const std::uint32_t distance = distance_to_root(other);
        if (distance < least) least = distance, best = a;
    }
    if (best != k_no_arc) stamp_[orphan] = time_, distance_[orphan] = least + 1;
    return best;
}

std::uint32_t MaxFlow::distance_to_root(Node node) {
    std::uint32_t distance = 0;
    for (Node i = node;; i = arcs_[parent_[i]].head) {
        if (stamp_[i] == time_) {
            distance += distance_[i];
            break;
        }
        if (parent_[i] == k_orphan) return k_unreachable;
        ++distance;
        if (parent_[i] == k_root) {
            stamp_[i] = time_;
            distance_[i] = 1;
            break;
        }
    }
    std::uint32_t left = distance;
    for (Node i = node; stamp_[i] != time_; i = arcs_[parent_[i]].head) {
        stamp_[i] = time_;
        distance_[i] = left--;
    }
    return distance;
}

void MaxFlow::set_free(Node orphan) {
    const Tree tree = tree_[orphan];
    for (ArcIndex a = first_[orphan]; a < first_[orphan + 1]; ++a) {
        const Node other = arcs_[a].head;
        if (tree_[other] != tree) continue;
        if (arcs_[along_flow(tree, a)].residual > 0.0) activate(other);  // it can grow back to here
        if (is_arc(parent_[other]) && arcs_[parent_[other]].head == orphan) make_orphan(other);
    }
    tree_[orphan] = Tree::none;
    parent_[orphan] = k_no_arc;
}

}  // namespace exemplar
