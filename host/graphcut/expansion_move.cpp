#include "host/graphcut/expansion_move.h"

#include <cmath>
#include <limits>
#include <utility>

namespace exemplar {
namespace {

constexpr std::size_t k_never = std::numeric_limits<std::size_t>::max();

/// Returns whether V obeys the triangle inequality.
bool is_metric(const ExpansionProblem& problem) {
    const auto labels = static_cast<std::int32_t>(problem.labels);
    for (std::int32_t a = 0; a < labels; ++a) {
        for (std::int32_t b = 0; b < labels; ++b) {
            for (std::int32_t c = 0; c < labels; ++c) {
                if (problem.factor(a, b) > problem.factor(a, c) + problem.factor(c, b)) return false;
            }
        }
    }
    return true;
}

}  // namespace

double ExpansionProblem::cost(std::span<const std::int32_t> labeling) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < nodes; ++i) sum += unary_cost(i, labeling[i]);
    for (std::size_t e = 0; e < edges.size(); ++e)
        sum += pair_cost(weight[e], labeling[edges[e][0]], labeling[edges[e][1]]);
    return sum;
}

LabelExpansion::LabelExpansion(const ExpansionProblem& problem, MaxFlow& flow, std::vector<std::int32_t> labeling)
    : problem_(problem),
      flow_(flow),
      is_metric_(is_metric(problem)),
      labels_(std::move(labeling)),
      energy_(problem.cost(labels_)),
      unary_(problem.unary.size()),
      unary_of_label_(problem.nodes),
      weight_of_arc_(flow.arcs()),
      weight_around_(problem.nodes, 0.0),
      is_inner_(problem.nodes),
      tried_(problem.labels, k_never),
      is_marked_(problem.nodes, 0) {
    for (std::size_t e = 0; e < problem.edges.size(); ++e) {
        const auto [forward, backward] = flow.arcs_of_edge(e);
        if (forward == backward) continue;
        weight_of_arc_[forward] = weight_of_arc_[backward] = problem.weight[e];
        for (const Node node : problem.edges[e]) weight_around_[node] += problem.weight[e];
    }
    for (Node i = 0; i < problem.nodes; ++i) {
        const std::span<const float> costs = problem.unary.subspan(i * problem.labels, problem.labels);
        for (std::size_t l = 0; l < costs.size(); ++l) unary_[l * problem.nodes + i] = costs[l];
        unary_of_label_[i] = costs[static_cast<std::size_t>(labels_[i])];
        is_inner_[i] = has_equal_neighbors(i);
    }
}

bool LabelExpansion::has_equal_neighbors(Node node) const {
    for (ArcIndex a = flow_.first_arc(node); a < flow_.first_arc(node + 1); ++a) {
        if (labels_[flow_.head(a)] != labels_[node]) return false;
    }
    return true;
}

/// Returns the costs of an edge between two nodes without label alpha. A cut exists only if `keep` is at most
/// `takes` + `other_takes`; where V violates the triangle inequality, one of the latter is raised.
LabelExpansion::PairCosts LabelExpansion::pair_costs(Node node, ArcIndex arc) const {
    const Node neighbor = flow_.head(arc);
    const double weight = weight_of_arc_[arc];
    PairCosts costs{problem_.pair_cost(weight, labels_[node], labels_[neighbor]),
                    problem_.pair_cost(weight, alpha_, labels_[neighbor]),
                    problem_.pair_cost(weight, labels_[node], alpha_)};
    if (is_metric_) return costs;
    const double lack = costs.keep - costs.takes - costs.other_takes;
    if (lack <= 0.0) return costs;
    // The one-sided change that costs less by the unary terms keeps its true cost, as it is the likelier one.
    const double difference = gain_of_keeping(neighbor) - gain_of_keeping(node);
    const bool raise_other = difference > 0.0 || (difference == 0.0 && neighbor < node);
    (raise_other ? costs.other_takes : costs.takes) += lack;
    return costs;
}

/// Returns whether a node might take alpha if its neighbors do. Returns true where a quick test cannot tell.
bool LabelExpansion::may_follow(Node node) const {
    if (labels_[node] == alpha_) return false;
    if (!(is_metric_ || is_inner_[node])) return true;
    return gain_of_keeping(node) < problem_.pair_cost(weight_around_[node], labels_[node], alpha_);
}

/// Returns whether a node might take alpha alone.
bool LabelExpansion::may_lead(Node node) const {
    return is_inner_[node] ? labels_[node] != alpha_ && gain_of_keeping(node) < 0.0 : may_follow(node);
}

/// Collects the nodes that may gain by taking alpha now, but did not when alpha was last tried. Such a set contains
/// or touches a node whose label has changed since, so the search starts there and spreads to all connected nodes
/// that may follow. Returns false if there are too many for this to pay.
bool LabelExpansion::find_affected() {
    const std::size_t tried = tried_[static_cast<std::size_t>(alpha_)], most = problem_.nodes / 32;
    affected_.clear();
    if (tried == k_never || changed_.size() - tried > most) return false;
    const auto add = [this](Node node) {
        if (is_marked_[node] || !may_follow(node)) return;
        is_marked_[node] = 1;
        affected_.push_back(node);
    };
    const auto add_neighbors = [&](Node node) {
        for (ArcIndex a = flow_.first_arc(node); a < flow_.first_arc(node + 1); ++a) add(flow_.head(a));
    };
    for (std::size_t c = tried; c < changed_.size(); ++c) add(changed_[c]), add_neighbors(changed_[c]);
    for (std::size_t i = 0; i < affected_.size() && affected_.size() <= most; ++i) add_neighbors(affected_[i]);
    for (const Node node : affected_) is_marked_[node] = 0;
    return affected_.size() <= most;
}

/// Collects the nodes that may take alpha by themselves; only affected ones, if find_affected succeeds.
void LabelExpansion::find_leaders() {
    leaders_.clear();
    if (find_affected()) {
        for (const Node node : affected_) {
            if (may_lead(node)) leaders_.push_back(node);
        }
    } else {
        for (Node i = 0; i < problem_.nodes; ++i) {
            if (may_lead(i)) leaders_.push_back(i);
        }
    }
}

/// Sets the capacities of a node and its arcs. Source side: keep the label; sink side: take alpha.
void LabelExpansion::add_to_cut(Node node) {
    const ArcIndex begin = flow_.first_arc(node), end = flow_.first_arc(node + 1);
    double terminal = 0.0;
    if (labels_[node] == alpha_) {
        for (ArcIndex a = begin; a < end; ++a) flow_.set_arc(a, 0.0);
    } else if (is_inner_[node]) {
        terminal = gain_of_keeping(node);
        const double factor = problem_.factor(labels_[node], alpha_);
        for (ArcIndex a = begin; a < end; ++a) flow_.set_arc(a, weight_of_arc_[a] * factor);
    } else {
        terminal = gain_of_keeping(node);
        for (ArcIndex a = begin; a < end; ++a) {
            if (labels_[flow_.head(a)] == alpha_) {
                terminal -= problem_.pair_cost(weight_of_arc_[a], labels_[node], alpha_);
                flow_.set_arc(a, 0.0);
            } else {
                const PairCosts costs = pair_costs(node, a);
                terminal += costs.terminal();
                flow_.set_arc(a, costs.pull());
            }
        }
    }
    flow_.set_node(node, terminal);
}

/// Returns the change of the true energy if the takers take alpha.
double LabelExpansion::cost_of_taking() {
    for (const Node node : takers_) is_marked_[node] = 1;
    double change = 0.0;
    for (const Node node : takers_) {
        change += gain_of_keeping(node);
        for (ArcIndex a = flow_.first_arc(node); a < flow_.first_arc(node + 1); ++a) {
            const Node neighbor = flow_.head(a);
            const bool both = is_marked_[neighbor] != 0;
            if (both && neighbor < node) continue;  // counted there
            const double weight = weight_of_arc_[a];
            change += problem_.pair_cost(weight, alpha_, both ? alpha_ : labels_[neighbor]) -
                      problem_.pair_cost(weight, labels_[node], labels_[neighbor]);
        }
    }
    for (const Node node : takers_) is_marked_[node] = 0;
    return change;
}

void LabelExpansion::take() {
    for (const Node node : takers_) {
        labels_[node] = alpha_;
        unary_of_label_[node] = unary_of_alpha_[node];
        changed_.push_back(node);
    }
    tried_[static_cast<std::size_t>(alpha_)] = changed_.size();
    for (const Node node : takers_) {
        is_inner_[node] = has_equal_neighbors(node);
        for (ArcIndex a = flow_.first_arc(node); a < flow_.first_arc(node + 1); ++a)
            is_inner_[flow_.head(a)] = has_equal_neighbors(flow_.head(a));
    }
}

bool LabelExpansion::expand(std::int32_t alpha) {
    alpha_ = alpha;
    unary_of_alpha_ =
        std::span<const float>(unary_).subspan(static_cast<std::size_t>(alpha) * problem_.nodes, problem_.nodes);
    find_leaders();
    tried_[static_cast<std::size_t>(alpha)] = changed_.size();
    flow_.solve(leaders_, [this](Node node) { add_to_cut(node); });
    takers_.clear();
    for (const Node node : flow_.reached()) {
        if (flow_.on_sink_side(node)) takers_.push_back(node);
    }
    const double change = cost_of_taking();
    if (!(energy_ + change < energy_ - 1e-12 * std::abs(energy_))) return false;
    take();
    energy_ += change;
    return true;
}

}  // namespace exemplar
