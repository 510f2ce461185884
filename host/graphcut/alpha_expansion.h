#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "host/graphcut/max_flow.h"

namespace exemplar {

/// The energy of a labeling l: sum over nodes i of unary[i][l_i] plus, over edges e = (i, j), weight[e] * V(l_i, l_j).
struct LabelingEnergy {
    std::span<const float> unary;           ///< nodes x labels, node-major, finite
    std::span<const double> weight;         ///< one per edge, >= 0, finite
    std::span<const double> compatibility;  ///< V, labels x labels: symmetric, zero diagonal, >= 0, finite
};

struct ExpansionResult {
    std::vector<std::int32_t> labels;  ///< one per node
    std::vector<double> energies;      ///< at the start and after each accepted move; they never rise
    std::size_t sweeps = 0;            ///< passes over the labels
};

/// Minimizes energies of labelings of one graph by expansion moves (Boykov, Veksler and Zabih, PAMI 2001). For each
/// label in turn, a minimum cut finds the best set of nodes that change to it at once, until no label finds a better
/// one. If V is a metric, the result's energy is at most 2 max V / min V times the lowest (2 for Potts). Where V
/// violates the triangle inequality, the cost of one of the two one-sided changes of that edge is raised, so that a
/// cut exists; the cut then never underestimates the cost of a move, so the energy does not rise. Deterministic.
class AlphaExpansion {
  public:
    /// Throws UsageError for a node out of range.
    AlphaExpansion(std::size_t nodes, std::span<const std::array<std::uint32_t, 2>> edges);

    /// Starts from `initial` (one label per node), or, if it is empty, from each node's cheapest label. Throws
    /// UsageError for sizes that do not match, or labels or values that are out of range.
    ExpansionResult solve(const LabelingEnergy& energy, std::size_t labels, std::size_t max_sweeps = 100,
                          std::span<const std::int32_t> initial = {});

    /// Returns the energy of a labeling. Throws UsageError likewise.
    double evaluate(const LabelingEnergy& energy, std::size_t labels, std::span<const std::int32_t> labeling) const;

  private:
    std::vector<std::array<std::uint32_t, 2>> edges_;
    MaxFlow flow_;
};

/// One-off form of AlphaExpansion::solve. The number of nodes is unary.size() / labels.
ExpansionResult alpha_expansion(std::span<const float> unary, std::size_t labels,
                                std::span<const std::array<std::uint32_t, 2>> edges, std::span<const double> weight,
                                std::span<const double> compatibility, std::span<const std::int32_t> initial = {});

}  // namespace exemplar
