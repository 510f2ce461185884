#include "host/learn/softmax.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace exemplar {
namespace {

TEST(Softmax, OfLogarithmsIsTheirNumbersOverTheSum) {
    std::vector<double> values{std::log(1.0), std::log(2.0), std::log(5.0)};
    // A scale is a power of the numbers: 1, 4 and 25.
    EXPECT_NEAR(softmax_at(std::span<const double>(values), 1, 2.0), 4.0 / 30, 1e-15);
    EXPECT_NEAR(softmax_at(std::span<const double>(values), 2, 2.0), 25.0 / 30, 1e-15);
    softmax(std::span(values));
    EXPECT_NEAR(values[0], 0.125, 1e-15);
    EXPECT_NEAR(values[1], 0.25, 1e-15);
    EXPECT_NEAR(values[2], 0.625, 1e-15);
}

TEST(Softmax, DoesNotDependOnAConstantNorOverflow) {
    std::vector<float> values{3000, 3000 + std::log(3.0F), -3000};
    EXPECT_NEAR(softmax_at(std::span<const float>(values), 1, 1.0F), 0.75F, 1e-4F);
    softmax(std::span(values));
    EXPECT_NEAR(values[0], 0.25F, 1e-4F);
    EXPECT_NEAR(values[1], 0.75F, 1e-4F);
    EXPECT_EQ(values[2], 0);
    std::vector<double> one{-1e300};
    softmax(std::span(one));
    EXPECT_EQ(one[0], 1);
}

TEST(Softmax, OfTwoValuesIsTheLogisticOfTheirDifference) {
    for (const double x : {-700.0, -3.0, 0.0, 0.5, 40.0}) {
        std::vector<double> values{x, 0};
        softmax(std::span(values));
        EXPECT_NEAR(values[0], logistic(x), 1e-15) << x;
        EXPECT_NEAR(values[1], logistic(-x), 1e-15) << x;
    }
}

TEST(Logistic, IsThreeQuartersAtTheLogarithmOfThree) {
    EXPECT_EQ(logistic(0.0), 0.5);
    EXPECT_NEAR(logistic(std::log(3.0)), 0.75, 1e-15);
    EXPECT_NEAR(logistic(-std::log(3.0)), 0.25, 1e-15);
    EXPECT_EQ(logistic(1000.0), 1);
    EXPECT_EQ(logistic(-1000.0), 0);
}

TEST(Logistic, ItsLogarithmStaysFiniteWhereItUnderflows) {
    for (const double x : {-30.0, -1.0, 0.0, 2.0, 30.0})
        EXPECT_NEAR(log_logistic(x), std::log(logistic(x)), 1e-12) << x;
    EXPECT_EQ(log_logistic(-1000.0), -1000);
    EXPECT_EQ(log_logistic(-1000.0F), -1000);
    EXPECT_NEAR(log_logistic(40.0), -std::exp(-40.0), 1e-30);
}

}  // namespace
}  // namespace exemplar
