#include "apps/bench/kernels/baseline.h"

#include <gtest/gtest.h>

#include <cmath>

#include "host/core/random.h"

namespace exemplar {
namespace {

std::vector<double> noisy(double middle, double share, std::size_t count, Random& random) {
    std::vector<double> values;
    for (std::size_t i = 0; i < count; ++i) values.push_back(middle * (1 + share * random.normal()));
    return values;
}

TEST(Statistics, MediansAndTheirErrors) {
    EXPECT_EQ(median(std::vector{3.0, 1.0, 2.0}), 2);
    EXPECT_EQ(median(std::vector{4.0, 1.0, 2.0, 3.0}), 2.5);
    EXPECT_TRUE(std::isnan(median({})));
    EXPECT_EQ(relative_error(std::vector{5.0, 5.0, 5.0}), 0);
    // Of many medians of repeats, the deviation is what relative_error says of each, in the mean.
    Random random(1);
    constexpr std::size_t k_trials = 2000, k_repeats = 15;
    double squares = 0, errors = 0;
    for (std::size_t i = 0; i < k_trials; ++i) {
        const auto values = noisy(10, 0.1, k_repeats, random);
        squares += std::pow(median(values) / 10 - 1, 2);
        errors += relative_error(values);
    }
    EXPECT_NEAR(errors / k_trials, std::sqrt(squares / k_trials), 0.15 * errors / k_trials);
}

TEST(Statistics, StrayRepeatsDoNotCount) {
    std::vector<double> values{1.0, 1.01, 0.99, 1.0, 1.02, 0.98, 1.0};
    const double error = relative_error(values);
    values.back() = 50;
    EXPECT_NEAR(median(values), 1, 0.01);
    EXPECT_LT(relative_error(values), 2 * error + 0.01);
}

// Of 1000 comparisons of equally fast kernels almost none is called slower; of a kernel that takes a quarter longer,
// almost all are.
TEST(Ratio, TellsSlownessFromNoise) {
    Random random(2);
    std::size_t false_alarms = 0, found = 0;
    for (int i = 0; i < 1000; ++i) {
        const auto before = noisy(1, 0.05, 9, random);
        false_alarms += ratio_of(noisy(1, 0.05, 9, random), before).is_slower();
        found += ratio_of(noisy(1.25, 0.05, 9, random), before).is_slower();
    }
    EXPECT_LE(false_alarms, 20u);
    EXPECT_GE(found, 900u);
}

TEST(Ratio, SmallDifferencesDoNotCountHoweverCertain) {
    EXPECT_FALSE((Ratio{1.04, 0}).is_slower());
    EXPECT_TRUE((Ratio{1.06, 0}).is_slower());
    EXPECT_TRUE((Ratio{1 / 1.06, 0}).is_faster());
    EXPECT_FALSE((Ratio{1.5, 0.2}).is_slower());
}

Measurement measurement(double milliseconds, double of_references, double share = 0.001) {
    Random random(3);
    Measurement result;
    result.operation = "work";
    result.size = 100;
    result.kernels.push_back({"a.comp", noisy(milliseconds, share, 7, random), {}});
    result.references = {{"copy", noisy(of_references, share, 7, random)},
                         {"multiply_add", noisy(2 * of_references, share, 7, random)}};
    return result;
}

TEST(Baseline, DriftOfTheDeviceIsTakenAway) {
    const auto changes = changes_between({measurement(1.5, 3)}, {measurement(1, 2)});
    ASSERT_EQ(changes.size(), 1u);
    EXPECT_NEAR(changes[0].ratio.value, 1, 1e-6);
    EXPECT_NEAR(changes[0].drift, 1.5, 1e-6);
    EXPECT_FALSE(changes[0].ratio.is_slower());
}

TEST(Baseline, SlowerKernelsAreFound) {
    const auto changes = changes_between({measurement(1.3, 2)}, {measurement(1, 2)});
    ASSERT_EQ(changes.size(), 1u);
    EXPECT_TRUE(changes[0].ratio.is_slower());
    EXPECT_NEAR(changes[0].ratio.value, 1.3, 0.01);
}

TEST(Baseline, OnlyWhatBothHaveIsCompared) {
    Measurement other = measurement(1, 2);
    other.size = 200;
    EXPECT_TRUE(changes_between({measurement(1, 2)}, {other}).empty());
    other = measurement(1, 2);
    other.kernels[0].kernel = "b.comp";
    EXPECT_TRUE(changes_between({measurement(1, 2)}, {other}).empty());
}

}  // namespace
}  // namespace exemplar
