#include "host/learn/golden_section.h"

#include <gtest/gtest.h>

#include <cmath>

namespace exemplar {
namespace {

// Also where the smallest value is at an end. Each step narrows the interval to 0.618 of its length.
TEST(GoldenSection, FindsTheSmallestValue) {
    for (const double place : {-3.0, -2.9, 0.1, 4.75, 5.0}) {
        int evaluations = 0;
        const auto distance = [&](double x) { return ++evaluations, std::abs(x - place); };
        const auto [at, value] = golden_section_minimum(distance, -3, 5, 30);
        EXPECT_NEAR(at, place, 8 * std::pow(0.6181, 30)) << place;
        EXPECT_EQ(value, std::abs(at - place));
        EXPECT_EQ(evaluations, 32);
    }
}

}  // namespace
}  // namespace exemplar
