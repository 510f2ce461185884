#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace exemplar {

/// Maximum flow and minimum cut between a source and a sink, for graphs that are grids or meshes: two search trees that
/// are kept from one augmentation to the next (Boykov and Kolmogorov, PAMI 2004). The structure is fixed; capacities
/// are set anew for each problem, so that a series of problems on one graph allocates nothing.
/// Capacities are finite and not negative; integers below 2^53 give exact flows.
class MaxFlow {
  public:
    /// `edges`: pairs of nodes below `nodes`; each can carry flow in both directions. Parallel edges are allowed, an
    /// edge from a node to itself carries nothing. Throws UsageError for a node out of range.
    MaxFlow(std::size_t nodes, std::span<const std::array<std::uint32_t, 2>> edges);

    std::size_t nodes() const { return terminal_.size(); }

    /// Sets all capacities to zero.
    void clear();
    /// Adds capacities from the source to a node and from the node to the sink.
    void add_terminals(std::size_t node, double from_source, double to_sink);
    /// Sets the capacities of an edge: from its first node to its second, and back.
    void set_edge(std::size_t edge, double forward, double backward);

    /// The value of the maximum flow. Capacities are used up: clear and set them before the next call.
    double solve();
    /// After solve: whether the node is on the sink's side of a minimum cut. Nodes that neither terminal reaches are on
    /// the source's side.
    bool on_sink_side(std::size_t node) const { return tree_[node] == Tree::sink; }

  private:
    using Node = std::uint32_t;
    using ArcIndex = std::uint32_t;
    enum class Tree : std::uint8_t { none, source, sink };
    struct Arc {
        Node head;
        ArcIndex sister;  // the arc of the opposite direction
        double residual;
    };

    void plant_trees();
    ArcIndex find_meeting_arc();
    ArcIndex scan(Node node);
    void augment(ArcIndex meeting);
    double bottleneck(ArcIndex meeting) const;
    void push_to_root(Node node, double flow);
    void adopt_orphans();
    ArcIndex find_parent(Node orphan);
    std::uint32_t distance_to_root(Node node);
    void set_free(Node orphan);
    void activate(Node node);
    void make_orphan(Node node);
    /// The arc between a node and its parent in the direction that flow takes, given the arc from node to parent.
    ArcIndex along_flow(Tree tree, ArcIndex to_parent) const {
        return tree == Tree::source ? arcs_[to_parent].sister : to_parent;
    }

    std::vector<ArcIndex> first_;  // nodes + 1: the arcs that leave a node are neighbors
    std::vector<Arc> arcs_;
    std::vector<ArcIndex> arc_of_edge_;

    std::vector<double> terminal_;  // per node: residual from the source (> 0) or to the sink (< 0)
    std::vector<Tree> tree_;
    std::vector<ArcIndex> parent_;         // arc from the node to its parent, or a mark
    std::vector<std::uint32_t> distance_;  // arcs to the root, right as of stamp_
    std::vector<std::uint32_t> stamp_;
    std::vector<std::uint8_t> is_active_;
    std::vector<Node> active_;  // a queue that starts at next_active_
    std::vector<Node> orphans_;
    std::size_t next_active_ = 0;
    std::uint32_t time_ = 0;
    double flow_ = 0.0;
};

}  // namespace exemplar
