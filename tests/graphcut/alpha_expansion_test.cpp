#include "host/graphcut/alpha_expansion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "host/core/errors.h"
#include "host/core/random.h"

namespace exemplar {
namespace {

using LabelEdge = std::array<std::uint32_t, 2>;
constexpr double k_infinity = std::numeric_limits<double>::infinity();

struct Instance {
    std::size_t nodes, labels;
    std::vector<LabelEdge> edges;
    std::vector<float> unary;
    std::vector<double> weight, v;

    LabelingEnergy energy() const { return {unary, weight, v}; }
};

std::vector<double> potts(std::size_t labels) {
    std::vector<double> v(labels * labels, 1.0);
    for (std::size_t l = 0; l < labels; ++l) v[l * labels + l] = 0.0;
    return v;
}

Instance random_instance(std::size_t nodes, std::size_t labels, std::size_t edges, Random& random) {
    Instance out{nodes, labels, {}, {}, {}, potts(labels)};
    for (std::size_t e = 0; e < edges; ++e) {
        const auto a = static_cast<std::uint32_t>(random.index(nodes));
        const auto b = static_cast<std::uint32_t>(random.index(nodes));
        out.edges.push_back({a, b});
        out.weight.push_back(random.uniform() < 0.1 ? 0.0 : random.uniform(0.0, 2.0));
    }
    for (std::size_t i = 0; i < nodes * labels; ++i) out.unary.push_back(static_cast<float>(random.uniform(-1.0, 3.0)));
    return out;
}

/// Symmetric, with zero diagonal and no triangle inequality; with probability `prohibitive` so large that a pair never
/// pays.
std::vector<double> random_compatibility(std::size_t labels, double prohibitive, Random& random) {
    std::vector<double> v(labels * labels, 0.0);
    for (std::size_t a = 0; a < labels; ++a) {
        for (std::size_t b = 0; b < a; ++b) {
            const double value = random.uniform() < prohibitive ? 100.0 : random.uniform(0.01, 3.2);
            v[a * labels + b] = v[b * labels + a] = value;
        }
    }
    return v;
}

double lowest_energy(const Instance& instance) {
    const AlphaExpansion solver(instance.nodes, instance.edges);
    std::vector<std::int32_t> labeling(instance.nodes, 0);
    double lowest = k_infinity;
    for (bool more = true; more;) {
        lowest = std::min(lowest, solver.evaluate(instance.energy(), instance.labels, labeling));
        more = false;
        for (std::int32_t& label : labeling) {  // counts up
            if (static_cast<std::size_t>(++label) < instance.labels) {
                more = true;
                break;
            }
            label = 0;
        }
    }
    return lowest;
}

void expect_never_rising(const ExpansionResult& result) {
    for (std::size_t i = 1; i < result.energies.size(); ++i) EXPECT_LE(result.energies[i], result.energies[i - 1]);
}

TEST(AlphaExpansion, IsExactForTwoLabels) {
    Random random(1);
    for (int trial = 0; trial < 100; ++trial) {
        const Instance instance = random_instance(1 + random.index(10), 2, random.index(25), random);
        AlphaExpansion solver(instance.nodes, instance.edges);
        const ExpansionResult result = solver.solve(instance.energy(), 2);
        EXPECT_NEAR(solver.evaluate(instance.energy(), 2, result.labels), lowest_energy(instance), 1e-6) << trial;
        EXPECT_NEAR(result.energies.back(), solver.evaluate(instance.energy(), 2, result.labels), 1e-9);
    }
}

TEST(AlphaExpansion, IsWithinTwiceTheOptimumForPotts) {
    Random random(2);
    double excess = 0.0;
    for (int trial = 0; trial < 60; ++trial) {
        const std::size_t labels = 3 + random.index(2);
        Instance instance = random_instance(7, labels, 6 + random.index(10), random);
        for (float& cost : instance.unary) cost += 1.0f;  // the bound holds for costs that are not negative
        const ExpansionResult result =
            alpha_expansion(instance.unary, labels, instance.edges, instance.weight, instance.v);
        const double lowest = lowest_energy(instance);
        EXPECT_LE(result.energies.back(), 2.0 * lowest + 1e-9) << trial;
        EXPECT_GE(result.energies.back(), lowest - 1e-6) << trial;
        excess += result.energies.back() / lowest - 1.0;
        expect_never_rising(result);
    }
    EXPECT_LT(excess / 60, 0.01);  // the bound is loose: in practice nearly all are optimal
}

/// The lowest energy of the labelings in which any set of nodes takes alpha.
double best_expansion(const Instance& instance, const AlphaExpansion& solver, const std::vector<std::int32_t>& labels,
                      std::int32_t alpha) {
    double best = k_infinity;
    for (std::uint32_t set = 0; set < 1u << instance.nodes; ++set) {
        std::vector<std::int32_t> moved = labels;
        for (std::size_t i = 0; i < instance.nodes; ++i) {
            if (set >> i & 1) moved[i] = alpha;
        }
        best = std::min(best, solver.evaluate(instance.energy(), instance.labels, moved));
    }
    return best;
}

TEST(AlphaExpansion, NoExpansionMoveImprovesTheResultForAMetric) {
    Random random(7);
    for (int trial = 0; trial < 60; ++trial) {
        const std::size_t labels = 3 + random.index(3);
        Instance instance = random_instance(7, labels, 6 + random.index(12), random);
        std::vector<std::array<double, 2>> points(labels);  // distances in a plane are a metric
        for (auto& point : points) point = {random.uniform(0.0, 2.0), random.uniform(0.0, 2.0)};
        for (std::size_t a = 0; a < labels; ++a) {
            for (std::size_t b = 0; b < labels; ++b) {
                instance.v[a * labels + b] = std::hypot(points[a][0] - points[b][0], points[a][1] - points[b][1]);
            }
        }
        AlphaExpansion solver(instance.nodes, instance.edges);
        const ExpansionResult result = solver.solve(instance.energy(), labels);
        const double energy = solver.evaluate(instance.energy(), labels, result.labels);
        for (std::size_t alpha = 0; alpha < labels; ++alpha) {
            EXPECT_GE(best_expansion(instance, solver, result.labels, static_cast<std::int32_t>(alpha)), energy - 1e-9)
                << trial << " " << alpha;
        }
    }
}

TEST(AlphaExpansion, ATruncatedMoveIsNeverWorseThanStayingOrTakingAlphaEverywhere) {
    // Truncation raises the cost of one-sided changes only: staying and all nodes changing keep their true energies, so
    // a result that a uniform labeling beats would show a wrong cut.
    Random random(8);
    for (int trial = 0; trial < 100; ++trial) {
        const std::size_t labels = 3 + random.index(3);
        Instance instance = random_instance(9, labels, 20, random);
        for (double& weight : instance.weight) weight *= 3.0;
        instance.v = random_compatibility(labels, 0.2, random);
        AlphaExpansion solver(instance.nodes, instance.edges);
        const double energy =
            solver.evaluate(instance.energy(), labels, solver.solve(instance.energy(), labels).labels);
        for (std::size_t label = 0; label < labels; ++label) {
            const std::vector<std::int32_t> uniform(instance.nodes, static_cast<std::int32_t>(label));
            EXPECT_LE(energy, solver.evaluate(instance.energy(), labels, uniform) + 1e-9) << trial;
        }
    }
}

TEST(AlphaExpansion, NeverRisesWithoutTriangleInequality) {
    Random random(3);
    double excess = 0.0;
    for (int trial = 0; trial < 100; ++trial) {
        const std::size_t labels = 3 + random.index(2);
        Instance instance = random_instance(7, labels, 6 + random.index(10), random);
        for (float& cost : instance.unary) cost += 1.0f;
        instance.v = random_compatibility(labels, 0.0, random);
        AlphaExpansion solver(instance.nodes, instance.edges);
        const ExpansionResult result = solver.solve(instance.energy(), labels);
        expect_never_rising(result);
        EXPECT_NEAR(result.energies.back(), solver.evaluate(instance.energy(), labels, result.labels), 1e-9);
        excess += result.energies.back() / lowest_energy(instance) - 1.0;
    }
    EXPECT_LT(excess / 100, 0.05);
}

TEST(AlphaExpansion, SmoothsNoiseOnAGrid) {
    const std::size_t side = 24;
    Instance grid{side * side, 3, {}, {}, {}, potts(3)};
    Random random(5);
    std::vector<std::int32_t> truth;
    for (std::uint32_t i = 0; i < side * side; ++i) {
        truth.push_back(static_cast<std::int32_t>(i % side * 3 / side));
        const auto noisy = random.uniform() < 0.25 ? static_cast<std::int32_t>(random.index(3)) : truth.back();
        for (std::int32_t l = 0; l < 3; ++l) grid.unary.push_back(l == noisy ? 0.0f : 1.0f);
        if (i % side + 1 < side) grid.edges.push_back({i, i + 1});
        if (i + side < side * side) grid.edges.push_back({i, i + static_cast<std::uint32_t>(side)});
    }
    grid.weight.assign(grid.edges.size(), 0.8);
    const ExpansionResult result = alpha_expansion(grid.unary, 3, grid.edges, grid.weight, grid.v);
    std::size_t right = 0;
    for (std::size_t i = 0; i < truth.size(); ++i) right += result.labels[i] == truth[i];
    EXPECT_GT(right, truth.size() * 97 / 100);
}

TEST(AlphaExpansion, LooksAgainWhereverALargeLabelingCouldStillGain) {
    // Later sweeps look only near what has changed; a fresh start from the result looks everywhere.
    Random random(11);
    int with_later_sweeps = 0;
    for (int trial = 0; trial < 12; ++trial) {
        constexpr std::uint32_t k_side = 40;
        Instance instance{std::size_t{k_side} * k_side, 5, {}, {}, {}, potts(5)};
        if (trial % 3 == 1) instance.v = random_compatibility(5, 0.0, random);
        if (trial % 3 == 2) instance.v = random_compatibility(5, 0.3, random);
        for (std::uint32_t i = 0; i < k_side * k_side; ++i) {
            if ((i + 1) % k_side != 0) instance.edges.push_back({i, i + 1});
            if (i + k_side < k_side * k_side) instance.edges.push_back({i, i + k_side});
        }
        const double strongest = random.uniform(0.1, 1.0);
        for (std::size_t e = 0; e < instance.edges.size(); ++e)
            instance.weight.push_back(random.uniform(0.0, strongest));
        for (std::size_t i = 0; i < instance.nodes * 5; ++i)
            instance.unary.push_back(static_cast<float>(random.uniform(0.0, 2.0)));
        AlphaExpansion solver(instance.nodes, instance.edges);
        const ExpansionResult result = solver.solve(instance.energy(), 5);
        if (result.sweeps > 2) ++with_later_sweeps;  // the first sweep looks everywhere anyway
        EXPECT_NEAR(result.energies.back(), solver.evaluate(instance.energy(), 5, result.labels), 1e-6) << trial;
        const ExpansionResult again = solver.solve(instance.energy(), 5, 100, result.labels);
        EXPECT_EQ(again.labels, result.labels) << trial;
    }
    EXPECT_GE(with_later_sweeps, 6);
}

TEST(AlphaExpansion, IsDeterministicAndReusable) {
    Random random(6);
    Instance instance = random_instance(300, 5, 700, random);
    AlphaExpansion solver(instance.nodes, instance.edges);
    const ExpansionResult first = solver.solve(instance.energy(), 5);
    Instance other = instance;
    other.v = random_compatibility(5, 0.3, random);
    solver.solve(other.energy(), 5);
    const ExpansionResult again = solver.solve(instance.energy(), 5);
    EXPECT_EQ(first.labels, again.labels);
    EXPECT_EQ(first.energies, again.energies);
    // Its own result cannot be improved.
    const ExpansionResult resumed = solver.solve(instance.energy(), 5, 100, first.labels);
    EXPECT_EQ(resumed.labels, first.labels);
    EXPECT_EQ(resumed.energies.size(), 1u);
}

TEST(AlphaExpansion, TakesEachNodesCheapestLabelWithoutEdges) {
    const std::vector<float> unary{3, 1, 2, 0, 5, 5};
    const ExpansionResult result = alpha_expansion(unary, 3, {}, {}, potts(3));
    EXPECT_EQ(result.labels, (std::vector<std::int32_t>{1, 0}));
    EXPECT_EQ(result.energies.back(), 1.0);
}

TEST(AlphaExpansion, RefusesBadEnergies) {
    const std::vector<LabelEdge> edges{{0, 1}};
    const std::vector<float> unary{0, 1, 1, 0}, bad_unary{0, 1, std::nanf(""), 0};
    const std::vector<double> weight{1.0}, bad_weight{-1.0};
    const std::vector<double> v{0, 1, 1, 0}, lopsided{0, 1, 2, 0}, diagonal{1, 1, 1, 0}, negative{0, -1, -1, 0},
        infinite{0, k_infinity, k_infinity, 0};
    EXPECT_NO_THROW(alpha_expansion(unary, 2, edges, weight, v));
    EXPECT_THROW(alpha_expansion(bad_unary, 2, edges, weight, v), UsageError);
    EXPECT_THROW(alpha_expansion(unary, 2, edges, bad_weight, v), UsageError);
    EXPECT_THROW(alpha_expansion(unary, 2, edges, {}, v), UsageError);
    EXPECT_THROW(alpha_expansion(unary, 3, edges, weight, v), UsageError);
    EXPECT_THROW(alpha_expansion(unary, 0, edges, weight, v), UsageError);
    for (const std::vector<double>& bad : {lopsided, diagonal, negative, infinite}) {
        EXPECT_THROW(alpha_expansion(unary, 2, edges, weight, bad), UsageError);
    }
    const std::vector<std::int32_t> bad_initial{0, 2};
    EXPECT_THROW(alpha_expansion(unary, 2, edges, weight, v, bad_initial), UsageError);
}

}  // namespace
}  // namespace exemplar
