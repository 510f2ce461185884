#include "host/graphcut/alpha_expansion.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "host/core/errors.h"

namespace exemplar {

namespace {

constexpr std::size_t k_forbidding_stages = 8;

void check_energy(const LabelingEnergy& energy, std::size_t nodes, std::size_t edges, std::size_t labels) {
    if (labels == 0 || energy.unary.size() != nodes * labels || energy.weight.size() != edges ||
        energy.compatibility.size() != labels * labels) {
        throw UsageError("the energy of " + std::to_string(nodes) + " nodes, " + std::to_string(edges) + " edges and " +
                         std::to_string(labels) + " labels has " + std::to_string(energy.unary.size()) +
                         " unary costs, " + std::to_string(energy.weight.size()) + " weights and " +
                         std::to_string(energy.compatibility.size()) + " compatibilities; the sizes do not match");
    }
    for (const float cost : energy.unary) {
        if (!std::isfinite(cost))
            throw UsageError("a unary cost is not finite; bound the probabilities away from zero");
    }
    for (const double weight : energy.weight) {
        if (!(weight >= 0.0) || std::isinf(weight)) throw UsageError("an edge weight is negative or not finite");
    }
    for (std::size_t a = 0; a < labels; ++a) {
        for (std::size_t b = 0; b < labels; ++b) {
            const double v = energy.compatibility[a * labels + b];
            if (!(v >= 0.0) || v != energy.compatibility[b * labels + a] || (a == b && v != 0.0)) {
                throw UsageError("the compatibility of labels " + std::to_string(a) + " and " + std::to_string(b) +
                                 " is wrong: V must be symmetric, not negative and zero for equal labels");
            }
        }
    }
}

double largest_finite(std::span<const double> values) {
    double largest = 0.0;
    for (const double value : values) {
        if (!std::isinf(value)) largest = std::max(largest, value);
    }
    return largest;
}

/// Returns more than any energy difference between labelings without forbidden pairs.
double cost_above_all(const LabelingEnergy& energy, std::size_t labels) {
    double range = 1.0;
    for (std::size_t i = 0; i < energy.unary.size(); i += labels) {
        const auto [low, high] = std::ranges::minmax(energy.unary.subspan(i, labels));
        range += static_cast<double>(high) - static_cast<double>(low);
    }
    const double largest = largest_finite(energy.compatibility);
    for (const double weight : energy.weight) range += weight * largest;
    return range;
}

void check_labels(std::span<const std::int32_t> labeling, std::size_t nodes, std::size_t labels) {
    if (labeling.size() != nodes) {
        throw UsageError("the labeling has " + std::to_string(labeling.size()) + " labels for " +
                         std::to_string(nodes) + " nodes");
    }
    for (const std::int32_t label : labeling) {
        if (label < 0 || static_cast<std::size_t>(label) >= labels) {
            throw UsageError("label " + std::to_string(label) + " is out of range; labels are 0 to " +
                             std::to_string(labels - 1));
        }
    }
}

std::vector<std::int32_t> cheapest_labels(std::span<const float> unary, std::size_t labels) {
    std::vector<std::int32_t> labeling;
    for (std::size_t i = 0; i < unary.size(); i += labels) {
        const std::span<const float> costs = unary.subspan(i, labels);
        labeling.push_back(static_cast<std::int32_t>(std::ranges::min_element(costs) - costs.begin()));
    }
    return labeling;
}

std::vector<std::int32_t> cheapest_single_label(std::span<const float> unary, std::size_t nodes, std::size_t labels) {
    std::vector<double> total(labels, 0.0);
    for (std::size_t i = 0; i < unary.size(); ++i) total[i % labels] += static_cast<double>(unary[i]);
    const auto best = static_cast<std::int32_t>(std::ranges::min_element(total) - total.begin());
    return std::vector<std::int32_t>(nodes, best);
}

}  // namespace

AlphaExpansion::AlphaExpansion(std::size_t nodes, std::span<const std::array<std::uint32_t, 2>> edges)
    : edges_(edges.begin(), edges.end()), flow_(nodes, edges) {}

double AlphaExpansion::evaluate(const LabelingEnergy& energy, std::size_t labels,
                                std::span<const std::int32_t> labeling) const {
    check_energy(energy, flow_.nodes(), edges_.size(), labels);
    check_labels(labeling, flow_.nodes(), labels);
    double sum = 0.0;
    for (std::size_t i = 0; i < labeling.size(); ++i) {
        sum += static_cast<double>(energy.unary[i * labels + static_cast<std::size_t>(labeling[i])]);
    }
    for (std::size_t e = 0; e < edges_.size(); ++e) {
        const auto a = static_cast<std::size_t>(labeling[edges_[e][0]]);
        const auto b = static_cast<std::size_t>(labeling[edges_[e][1]]);
        if (a != b && energy.weight[e] > 0.0) sum += energy.weight[e] * energy.compatibility[a * labels + b];
    }
    return sum;
}

ExpansionResult AlphaExpansion::descend(const ExpansionProblem& problem, std::size_t max_sweeps,
                                        std::vector<std::int32_t> labeling) {
    LabelExpansion expansion(problem, flow_, std::move(labeling));
    ExpansionResult result;
    result.energies.push_back(expansion.energy());
    std::size_t in_vain = 0;  // labels tried since the last change
    for (; result.sweeps < max_sweeps && in_vain < problem.labels; ++result.sweeps) {
        for (std::size_t alpha = 0; alpha < problem.labels && in_vain < problem.labels; ++alpha) {
            ++in_vain;
            if (!expansion.expand(static_cast<std::int32_t>(alpha))) continue;
            in_vain = 0;
            result.energies.push_back(expansion.energy());
        }
    }
    result.labels = std::move(expansion.labels());
    return result;
}

ExpansionResult AlphaExpansion::solve(const LabelingEnergy& energy, std::size_t labels, std::size_t max_sweeps,
                                      std::span<const std::int32_t> initial) {
    const std::size_t nodes = flow_.nodes();
    check_energy(energy, nodes, edges_.size(), labels);
    ExpansionProblem problem{nodes, labels, edges_, energy.unary, energy.weight, energy.compatibility};
    problem.forbidden_cost = cost_above_all(energy, labels);
    if (!initial.empty()) {
        check_labels(initial, flow_.nodes(), labels);
        return descend(problem, max_sweeps, {initial.begin(), initial.end()});
    }
    const auto broken = [&](std::span<const std::int32_t> of) { return std::isinf(evaluate(energy, labels, of)); };
    std::vector<std::int32_t> start = cheapest_labels(energy.unary, labels);
    // The cost of forbidden pairs rises step by step. If they were forbidden at once, the first label that fits
    // would replace all labels in conflict, and expansion moves do not undo that.
    problem.forbidden_factor = std::max(largest_finite(energy.compatibility), 1e-3);
    for (std::size_t stage = 0; stage < k_forbidding_stages && broken(start); ++stage) {
        start = descend(problem, max_sweeps, std::move(start)).labels;
        problem.forbidden_factor *= 4.0;
    }
    problem.forbidden_factor = 0.0;
    ExpansionResult result = descend(problem, max_sweeps, std::move(start));
    if (!broken(result.labels)) return result;
    return descend(problem, max_sweeps, cheapest_single_label(energy.unary, flow_.nodes(), labels));
}

ExpansionResult alpha_expansion(std::span<const float> unary, std::size_t labels,
                                std::span<const std::array<std::uint32_t, 2>> edges, std::span<const double> weight,
                                std::span<const double> compatibility, std::span<const std::int32_t> initial) {
    if (labels == 0 || unary.size() % labels != 0) {
        throw UsageError("there are " + std::to_string(unary.size()) + " unary costs, which is no multiple of " +
                         std::to_string(labels) + " labels");
    }
    AlphaExpansion solver(unary.size() / labels, edges);
    return solver.solve({unary, weight, compatibility}, labels, 100, initial);
}

}  // namespace exemplar
