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
    std::size_t edges() const { return arc_of_edge_.size(); }

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
    using Arc = std::uint32_t;
    enum class Tree : std::uint8_t { none, source, sink };

    void grow_from_terminals();
    bool find_path(Arc& meeting);
    bool scan(Node node, Arc& meeting);
    void augment(Arc meeting);
    double bottleneck(Arc meeting) const;
    void push(Arc arc, double flow);
    void use_terminal(Node node, double flow);
    void adopt_orphans();
    void adopt(Node orphan);
    Arc find_parent(Node orphan);
    std::uint32_t distance_to_terminal(Node node);
    void set_free(Node orphan);
    void activate(Node node);
    void make_orphan(Node node);
    /// Residual capacity of an arc in the direction flow takes in the tree: toward the sink.
    double residual_into(Tree tree, Arc arc) const { return tree == Tree::source ? residual_[arc ^ 1] : residual_[arc]; }

    // Arcs come in pairs (2e, 2e + 1) of opposite directions; the arcs that leave a node are listed in CSR form.
    std::vector<std::uint32_t> first_;       // nodes + 1
    std::vector<Arc> leaving_;               // arcs by node
    std::vector<Node> head_;                 // per arc
    std::vector<double> residual_;           // per arc
    std::vector<std::uint32_t> arc_of_edge_;

    std::vector<double> terminal_;  // per node: residual from the source (> 0) or to the sink (< 0)
    std::vector<Tree> tree_;
    std::vector<Arc> parent_;             // arc from the node to its parent, or a mark
    std::vector<std::uint32_t> stamp_;    // time at which distance_ was known to be right
    std::vector<std::uint32_t> distance_;
    std::vector<std::uint8_t> is_active_;
    std::vector<Node> active_;
    std::vector<Node> orphans_;
    std::size_t next_active_ = 0;
    std::uint32_t time_ = 0;
    double flow_ = 0.0;
};

}  // namespace exemplar
