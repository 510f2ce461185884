#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "host/graphcut/max_flow.h"

namespace exemplar {

/// An energy (see LabelingEnergy) of a graph.
struct ExpansionProblem {
    std::size_t nodes, labels;
    std::span<const std::array<std::uint32_t, 2>> edges;
    std::span<const float> unary;
    std::span<const double> weight;
    std::span<const double> v;

    double unary_cost(std::size_t node, std::int32_t label) const {
        return static_cast<double>(unary[node * labels + static_cast<std::size_t>(label)]);
    }
    double factor(std::int32_t a, std::int32_t b) const {
        return v[static_cast<std::size_t>(a) * labels + static_cast<std::size_t>(b)];
    }
    /// Returns the cost of an edge of this weight between nodes of these labels.
    double pair_cost(double weight_of_edge, std::int32_t a, std::int32_t b) const {
        return weight_of_edge * factor(a, b);
    }
    double cost(std::span<const std::int32_t> labeling) const;
};

/// A labeling that expansion moves improve.
class LabelExpansion {
  public:
    /// `flow` must have the problem's graph.
    LabelExpansion(const ExpansionProblem& problem, MaxFlow& flow, std::vector<std::int32_t> labeling);

    /// Makes the best move to `alpha` if it lowers the energy by more than rounding. Returns whether it did.
    bool expand(std::int32_t alpha);
    double energy() const { return energy_; }
    std::vector<std::int32_t>& labels() { return labels_; }

  private:
    using Node = MaxFlow::Node;
    using ArcIndex = MaxFlow::ArcIndex;
    // Costs of an edge in a move, seen from one of its nodes: both keep their labels, only this one takes alpha, or
    // only the other takes it. If both take it, the edge costs nothing. With x = 1 for taking alpha, and ' for the
    // other node, the cost is, up to a constant, terminal() x + terminal'() x' + pull() |x - x'|.
    struct PairCosts {
        double keep, takes, other_takes;
        double terminal() const { return 0.5 * (takes - keep - other_takes); }
        double pull() const { return std::max(0.0, 0.5 * (takes + other_takes - keep)); }
    };

    double gain_of_keeping(Node node) const {
        return static_cast<double>(unary_of_alpha_[node]) - static_cast<double>(unary_of_label_[node]);
    }
    bool may_follow(Node node) const;
    bool may_lead(Node node) const;
    bool find_affected();
    void find_leaders();
    PairCosts pair_costs(Node node, ArcIndex arc) const;
    void add_to_cut(Node node);
    double cost_of_taking();
    void take();
    bool has_equal_neighbors(Node node) const;

    const ExpansionProblem& problem_;
    MaxFlow& flow_;
    bool is_metric_;
    std::vector<std::int32_t> labels_;
    double energy_;
    std::vector<float> unary_;            // labels x nodes
    std::vector<float> unary_of_label_;   // of each node's current label
    std::vector<double> weight_of_arc_;   // one per arc of the flow's graph
    std::vector<double> weight_around_;   // per node: the sum of its arcs' weights
    std::vector<std::uint8_t> is_inner_;  // per node: whether all neighbors have its label

    std::vector<Node> changed_;       // all nodes that changed their label, in order
    std::vector<std::size_t> tried_;  // per label: size of changed_ when it was last tried, or k_never

    // The current move.
    std::int32_t alpha_ = 0;
    std::span<const float> unary_of_alpha_;
    std::vector<Node> affected_, leaders_, takers_;
    std::vector<std::uint8_t> is_marked_;  // per node; zero between steps
};

}  // namespace exemplar
