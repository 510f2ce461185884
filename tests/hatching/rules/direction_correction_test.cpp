#include "host/hatching/rules/direction_correction.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>
#include <vector>

#include "host/core/errors.h"
#include "host/core/random.h"

namespace exemplar {
namespace {

constexpr std::size_t k_items = 3000, k_features = 12;

double degrees_between(const DoubledAngle& a, const DoubledAngle& b) {
    const double cosine = std::clamp(static_cast<double>(a[0] * b[0] + a[1] * b[1]), -1.0, 1.0);
    return 0.5 * std::acos(cosine) * 180 / std::numbers::pi;
}

/// Strokes that follow a rule, here the x axis, turned by an angle that depends on the features.
struct Strokes {
    OrientationFields fields{k_items};
    FeatureMatrix features;
    std::vector<DoubledAngle> target, rules;
    std::vector<std::int32_t> segment;
    std::vector<std::uint8_t> held_out;
    std::vector<std::uint32_t> which;

    explicit Strokes(const std::function<double(const FeatureMatrix&, std::size_t)>& turn) {
        Random random(3);
        for (DoubledAngle& v : fields.values) v = doubled_angle(static_cast<float>(random.uniform(0, 3.14159)));
        features.rows = k_items;
        for (std::uint32_t k = 0; k < k_features; ++k) {
            which.push_back(k);
            for (float& value : features.add(std::to_string(k))) value = static_cast<float>(random.uniform(-1, 1));
        }
        for (std::size_t i = 0; i < k_items; ++i) {
            rules.push_back(doubled_angle(0.0f));
            target.push_back(doubled_angle(static_cast<float>(turn(features, i))));
            segment.push_back(static_cast<std::int32_t>(i % 2));
            held_out.push_back(i % 4 == 0 ? 1 : 0);
        }
    }
    LearnedCorrection learn() const {
        return learn_correction({quantize(features, {}, {}), fields, target, rules, segment, 2, held_out, 1});
    }
    std::vector<DoubledAngle> corrected(const DirectionCorrection& correction) const {
        return corrected_directions(correction, rules, segment, fields, which, features);
    }
};

TEST(DirectionCorrection, PartsOfAFrameAre45DegreesApart) {
    OrientationFields fields(1);
    for (DoubledAngle& v : fields.values) v = doubled_angle(0.3f);
    EXPECT_EQ(direction_part(fields, 0, 0), doubled_angle(0.0f));
    for (std::size_t part = 0; part < k_direction_parts; part += 2)
        EXPECT_NEAR(degrees_between(direction_part(fields, part, 0), direction_part(fields, part + 1, 0)), 45, 1e-3);
}

TEST(DirectionCorrection, AnExactRuleStaysAlone) {
    const Strokes strokes([](const FeatureMatrix&, std::size_t) { return 0.0; });
    const LearnedCorrection learned = strokes.learn();
    EXPECT_TRUE(learned.correction.stumps.empty());
    EXPECT_EQ(learned.correction.rule_weight, (std::vector<float>{1, 1}));
    EXPECT_EQ(strokes.corrected(learned.correction), strokes.rules);
}

TEST(DirectionCorrection, LearnsHowStrokesDepartFromTheirRule) {
    // By up to 60 degrees, smoothly with one feature and at once with another.
    const Strokes strokes([](const FeatureMatrix& features, std::size_t i) {
        return 0.7 * static_cast<double>(features.column(4)[i]) + (features.column(7)[i] > 0.3f ? 0.5 : 0.0);
    });
    const LearnedCorrection learned = strokes.learn();
    EXPECT_LT(learned.error, 0.1 * learned.rule_error);
    const std::vector<DoubledAngle> directions = strokes.corrected(learned.correction);
    double sum = 0;
    for (std::size_t i = 0; i < k_items; ++i) sum += degrees_between(directions[i], strokes.target[i]);
    EXPECT_LT(sum / k_items, 7);
    for (const DirectionStump& stump : learned.correction.stumps) {
        EXPECT_LT(stump.feature, k_features);
        EXPECT_LT(stump.part, k_direction_parts);
    }
    EXPECT_EQ(strokes.learn().correction, learned.correction);
}

TEST(DirectionCorrection, NoiseIsNotLearned) {
    Random random(5);
    const Strokes strokes([&](const FeatureMatrix&, std::size_t) { return 0.2 * random.normal(); });
    const LearnedCorrection learned = strokes.learn();
    EXPECT_LE(learned.error, learned.rule_error);
    for (const DoubledAngle& direction : strokes.corrected(learned.correction))
        EXPECT_LT(degrees_between(direction, strokes.rules[0]), 12);
}

TEST(DirectionCorrection, AFeatureThatWasNotMeasuredIsNamed) {
    const Strokes strokes([](const FeatureMatrix&, std::size_t) { return 0.0; });
    DirectionCorrection correction{{1, 1}, {{k_features, 0, 0, 0.5f, 0.5f}}};
    EXPECT_THROW(strokes.corrected(correction), UsageError);
}

TEST(DirectionCorrection, CrossingWithoutARuleIsAtRightAngles) {
    const std::vector<DoubledAngle> hatches{doubled_angle(0.2f), doubled_angle(1.0f)};
    std::vector<DoubledAngle> crossing{DoubledAngle{}, doubled_angle(0.5f)};
    cross_at_right_angles(hatches, crossing);
    EXPECT_NEAR(degrees_between(crossing[0], hatches[0]), 90, 1e-3);
    EXPECT_EQ(crossing[1], doubled_angle(0.5f));
}

}  // namespace
}  // namespace exemplar
