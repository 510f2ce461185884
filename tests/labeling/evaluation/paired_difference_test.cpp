#include "host/labeling/evaluation/paired_difference.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "host/core/random.h"

namespace exemplar {
namespace {

TEST(PairedDifference, CategoriesCountTheSame) {
    const std::vector<PairedDifference> differences{{"a", "1", 1}, {"a", "2", 3}, {"a", "3", 2}, {"b", "1", -2}};
    EXPECT_DOUBLE_EQ(estimate_difference(differences).mean, 0);
    EXPECT_DOUBLE_EQ(mean_over_categories(differences), 0);
}

TEST(PairedDifference, WithoutDifferencesNothingIsKnown) {
    EXPECT_TRUE(std::isnan(estimate_difference({}).mean));
    EXPECT_TRUE(std::isnan(estimate_difference({}).lowest));
}

TEST(PairedDifference, MeshesOfOneCategoryAreNotDrawnForAnother) {
    const std::vector<PairedDifference> differences{{"a", "1", 4}, {"a", "2", 4}, {"b", "1", 0}, {"b", "2", 0}};
    const DifferenceEstimate estimate = estimate_difference(differences);
    EXPECT_DOUBLE_EQ(estimate.lowest, 2);
    EXPECT_DOUBLE_EQ(estimate.highest, 2);
}

/// The interval of `count` meshes with unit deviation, each measured `times` times with the same result.
DifferenceEstimate of_normal(std::size_t count, std::size_t times, std::uint64_t seed) {
    Random random(seed);
    std::vector<PairedDifference> differences;
    for (std::size_t i = 0; i < count; ++i) {
        const double value = 0.5 + random.normal();
        for (std::size_t k = 0; k < times; ++k) differences.push_back({"a", std::to_string(i), value});
    }
    return estimate_difference(differences);
}

TEST(PairedDifference, HoldsTheTrueMeanInNineteenOfTwentyCases) {
    int held = 0;
    for (std::uint64_t seed = 1; seed <= 200; ++seed) {
        const DifferenceEstimate estimate = of_normal(50, 1, seed);
        held += estimate.lowest <= 0.5 && 0.5 <= estimate.highest ? 1 : 0;
    }
    EXPECT_GE(held, 180);  // 190 +- 3 deviations
    EXPECT_LE(held, 199);
}

TEST(PairedDifference, MeasuringMeshesAgainTellsNothingNew) {
    const DifferenceEstimate once = of_normal(40, 1, 7), often = of_normal(40, 5, 7);
    EXPECT_NEAR(often.highest - often.lowest, once.highest - once.lowest, 1e-9);
    EXPECT_NEAR(once.highest - once.lowest, 2 * 1.96 / std::sqrt(40.0), 0.15);
}

TEST(PairedDifference, EqualSeedsGiveEqualIntervals) {
    const std::vector<PairedDifference> differences{{"a", "1", 1}, {"a", "2", 3}, {"a", "3", 9}, {"a", "4", -2}};
    EXPECT_EQ(estimate_difference(differences, 3).lowest, estimate_difference(differences, 3).lowest);
}

}  // namespace
}  // namespace exemplar
