#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace exemplar {

/// Maximum flow and minimum cut between a source and a sink, for graphs that are grids or meshes with most nodes
/// tied to a terminal. A search tree grows from the sink and is kept between augmentations, as in Boykov and
/// Kolmogorov (PAMI 2004). There is no second tree from the source: source capacity is everywhere, so the sink's
/// tree soon finds some, and nodes far from all that leads to the sink are never visited. The graph is fixed;
/// capacities are set anew for each problem, so that a series of problems on one graph allocates nothing. Capacities
/// are finite; integers below 2^53 give exact cuts.
class MaxFlow {
  public:
    using Node = std::uint32_t;
    using ArcIndex = std::uint32_t;

    /// `edges`: pairs of nodes below `nodes`; each can carry flow in both directions. Parallel edges are allowed, an
    /// edge from a node to itself carries nothing. Throws UsageError for a node out of range.
    MaxFlow(std::size_t nodes, std::span<const std::array<Node, 2>> edges);

    std::size_t nodes() const { return vertices_.size() - 1; }
    std::size_t arcs() const { return arcs_.size(); }
    /// The arcs that leave a node are consecutive: from first_arc(node) up to first_arc(node + 1).
    ArcIndex first_arc(std::size_t node) const { return vertices_[node].first; }
    Node head(ArcIndex arc) const { return arcs_[arc].head; }
    /// Returns the two arcs of an edge, from its first node and from its second; equal if the edge carries nothing.
    std::array<ArcIndex, 2> arcs_of_edge(std::size_t edge) const;

    /// Solves with capacities that are set on demand. `start` holds all nodes with capacity to the sink, and may
    /// hold others. Before a node is first used, `reach` is called for it, and calls set_node for it and set_arc for
    /// its arcs.
    void solve(std::span<const Node> start, const std::function<void(Node)>& reach);
    /// Sets the capacity from the source to a node less that from the node to the sink: the smaller of the two goes
    /// straight through and changes no cut.
    void set_node(Node node, double from_source) { vertices_[node].terminal = from_source; }
    void set_arc(ArcIndex arc, double capacity) { arcs_[arc].residual = capacity; }

    /// After solve: returns whether the node is on the sink's side of the minimum cut whose sink side is smallest.
    bool on_sink_side(std::size_t node) const {
        return vertices_[node].problem == problem_ && vertices_[node].is_in_tree;
    }
    /// After solve: the nodes that the search reached; all others are on the source's side.
    std::span<const Node> reached() const { return reached_; }

  private:
    struct Arc {
        Node head;
        ArcIndex sister;  // the arc of the opposite direction
        double residual;
    };
    struct Vertex {
        double terminal = 0.0;       // residual from the source (> 0) or to the sink (< 0)
        ArcIndex first = 0;          // of its arcs
        std::uint32_t problem = 0;   // the problem that its capacities and all that follows belong to
        ArcIndex parent = 0;         // in the sink's tree: the arc from the node to its parent, or a mark
        std::uint32_t distance = 0;  // arcs to the root, valid as of stamp
        std::uint32_t stamp = 0;
        bool is_in_tree = false;
        bool is_active = false;
    };

    void start_problem();
    void reach(Node node);
    ArcIndex find_meeting_arc();
    ArcIndex scan(Node node);
    void augment(ArcIndex meeting);
    double bottleneck(ArcIndex meeting) const;
    void adopt_orphans();
    ArcIndex find_parent(Node orphan);
    std::uint32_t distance_to_root(Node node);
    void set_free(Node orphan);
    void activate(Node node);
    void make_orphan(Node node);

    std::vector<Vertex> vertices_;  // one more than there are nodes: the end of the last one's arcs
    std::vector<Arc> arcs_;
    std::vector<ArcIndex> arc_of_edge_;
    const std::function<void(Node)>* reach_ = nullptr;
    std::vector<Node> reached_;
    std::vector<Node> active_;  // a queue that starts at next_active_
    std::vector<Node> orphans_;
    std::size_t next_active_ = 0;
    std::uint32_t problem_ = 0;
    std::uint32_t time_ = 0;
};

}  // namespace exemplar
