#include "host/learn/regression/logistic_regression.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace exemplar {
namespace {

TEST(LogisticRegression, FindsTheCurveOfExactProbabilities) {
    const LogisticCurve truth{2.5, -4};
    std::vector<double> x, target, weight;
    for (int i = 0; i < 40; ++i) {
        x.push_back(0.1 * i);
        target.push_back(truth.probability(x.back()));
        weight.push_back(1 + i % 3);
    }
    const LogisticCurve found = fit_rising_logistic(x, target, weight);
    EXPECT_NEAR(found.slope, truth.slope, 1e-5);
    EXPECT_NEAR(found.offset, truth.offset, 1e-5);
}

TEST(LogisticRegression, PassesThroughTheWeightedMeansOfTwoValues) {
    // Two values of x: the curve takes the mean target at each, 3/4 at 1 and 1/4 at -1, so its slope is log 3.
    const std::vector<double> x{1, 1, -1, -1}, target{1, 0, 1, 0}, weight{3, 1, 1, 3};
    const LogisticCurve found = fit_rising_logistic(x, target, weight);
    EXPECT_NEAR(found.slope, std::log(3.0), 1e-7);
    EXPECT_NEAR(found.offset, 0, 1e-7);
    EXPECT_NEAR(found.probability(1), 0.75, 1e-8);
}

TEST(LogisticRegression, NeverFalls) {
    // The targets fall with x: the best curve that does not is their weighted mean.
    const std::vector<double> x{1, 2, 3}, target{0.9, 0.5, 0.1}, weight{2, 1, 1};
    const LogisticCurve found = fit_rising_logistic(x, target, weight);
    EXPECT_EQ(found.slope, 0);
    EXPECT_NEAR(found.probability(7), 0.6, 1e-12);
}

TEST(LogisticRegression, StaysFiniteWhereTheValueSeparatesSmoothedTargets) {
    const std::vector<double> x{-2, -1, 1, 2}, target{0.1, 0.1, 0.9, 0.9}, weight{1, 1, 1, 1};
    const LogisticCurve found = fit_rising_logistic(x, target, weight);
    EXPECT_GT(found.slope, 1);
    EXPECT_LT(found.slope, 5);
    EXPECT_NEAR(found.offset, 0, 1e-9);
}

}  // namespace
}  // namespace exemplar
