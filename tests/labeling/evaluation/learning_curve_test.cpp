#include "host/labeling/evaluation/learning_curve.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "host/core/errors.h"
#include "host/core/random.h"

namespace exemplar {
namespace {

std::vector<LearningPoint> points_of(const PowerLaw& law, double noise = 0) {
    Random random(1);
    std::vector<LearningPoint> points;
    for (const std::size_t shapes : {1, 2, 3, 4, 6, 8, 12})
        points.push_back({shapes, law.error(static_cast<double>(shapes)) + noise * random.normal()});
    return points;
}

TEST(LearningCurve, FindsTheLawOfItsPoints) {
    for (const PowerLaw& law : {PowerLaw{0.05, 0.3, 0.7}, PowerLaw{0, 0.2, 0.4}, PowerLaw{0.1, 0.05, 1.5}}) {
        const PowerLaw found = fit_power_law(points_of(law));
        EXPECT_NEAR(found.limit, law.limit, 1e-3);
        EXPECT_NEAR(found.factor, law.factor, 1e-3);
        EXPECT_NEAR(found.exponent, law.exponent, 1e-2);
    }
}

TEST(LearningCurve, PredictsABitFurtherFromNoisyPoints) {
    const PowerLaw law{0.05, 0.3, 0.7};
    EXPECT_NEAR(fit_power_law(points_of(law, 0.005)).error(15), law.error(15), 0.01);
}

TEST(LearningCurve, ErrorsThatRisePromiseNoGain) {
    const PowerLaw found = fit_power_law(std::vector<LearningPoint>{{1, 0.1}, {2, 0.2}, {3, 0.3}});
    EXPECT_DOUBLE_EQ(found.error(3), found.error(6));
    EXPECT_NEAR(found.error(3), 0.2, 1e-9);
}

TEST(LearningCurve, NeedsThreeNumbersOfShapes) {
    EXPECT_THROW(fit_power_law(std::vector<LearningPoint>{{1, 0.1}, {2, 0.2}, {2, 0.3}}), UsageError);
}

}  // namespace
}  // namespace exemplar
