#include "host/graphcut/alpha_expansion.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "host/core/errors.h"
#include "host/graphcut/expansion_move.h"

namespace exemplar {

namespace {

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
            if (!(v >= 0.0) || std::isinf(v) || v != energy.compatibility[b * labels + a] || (a == b && v != 0.0)) {
                throw UsageError("the compatibility of labels " + std::to_string(a) + " and " + std::to_string(b) +
                                 " is wrong: V must be symmetric, finite, not negative and zero for equal labels");
            }
        }
    }
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

}  // namespace

AlphaExpansion::AlphaExpansion(std::size_t nodes, std::span<const std::array<std::uint32_t, 2>> edges)
    : edges_(edges.begin(), edges.end()), flow_(nodes, edges) {}

double AlphaExpansion::evaluate(const LabelingEnergy& energy, std::size_t labels,
                                std::span<const std::int32_t> labeling) const {
    const std::size_t nodes = flow_.nodes();
    check_energy(energy, nodes, edges_.size(), labels);
    check_labels(labeling, nodes, labels);
    return ExpansionProblem{nodes, labels, edges_, energy.unary, energy.weight, energy.compatibility}.cost(labeling);
}

ExpansionResult AlphaExpansion::solve(const LabelingEnergy& energy, std::size_t labels, std::size_t max_sweeps,
                                      std::span<const std::int32_t> initial) {
    const std::size_t nodes = flow_.nodes();
    check_energy(energy, nodes, edges_.size(), labels);
    if (!initial.empty()) check_labels(initial, nodes, labels);
    const ExpansionProblem problem{nodes, labels, edges_, energy.unary, energy.weight, energy.compatibility};
    LabelExpansion expansion(problem, flow_,
                             initial.empty() ? cheapest_labels(energy.unary, labels)
                                             : std::vector<std::int32_t>(initial.begin(), initial.end()));
    ExpansionResult result;
    result.energies.push_back(expansion.energy());
    std::size_t in_vain = 0;  // labels tried since the last change
    for (; result.sweeps < max_sweeps && in_vain < labels; ++result.sweeps) {
        for (std::size_t alpha = 0; alpha < labels && in_vain < labels; ++alpha) {
            ++in_vain;
            if (!expansion.expand(static_cast<std::int32_t>(alpha))) continue;
            in_vain = 0;
            result.energies.push_back(expansion.energy());
        }
    }
    result.labels = std::move(expansion.labels());
    return result;
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
