#include "host/hatching/rules/orientation_mixture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "host/core/parallel.h"
#include "host/core/random.h"

namespace exemplar {
namespace {

constexpr int k_width = 240, k_height = 160, k_samples = 6000;
constexpr double k_degree = std::numbers::pi / 180;

/// Smooth fields of a picture: each turns by up to 40 degrees, or so many times that, in its own way, over it.
class SmoothFields {
  public:
    explicit SmoothFields(std::uint64_t seed, double times = 1) {
        Random random(seed);
        for (auto& [angle, along_x, along_y, wave] : fields_) {
            angle = random.uniform(0, std::numbers::pi);
            along_x = times * random.uniform(-0.5, 0.5) / k_width;
            along_y = times * random.uniform(-0.5, 0.5) / k_height;
            wave = random.uniform(0, 0.3);
        }
    }
    DoubledAngle at(std::size_t k, double x, double y) const {
        const auto& [angle, along_x, along_y, wave] = fields_[k];
        return doubled_angle(static_cast<float>(angle + along_x * x + along_y * y + wave * std::sin(0.03 * (x + y))));
    }

  private:
    std::array<std::array<double, 4>, k_orientation_fields> fields_;
};

struct Drawing {
    OrientationSamples samples;
    std::vector<std::uint32_t> region;  // of each sample: which rule it follows
    std::vector<OrientationRule> rules;
};

/// Rule 0 hatches the left, rule 1 the right; below the middle of the right its second direction crosses. Directions
/// are off by `noise` (a standard deviation in radians).
Drawing two_regions(double noise, std::uint64_t seed) {
    const SmoothFields fields(seed);
    Drawing drawing;
    drawing.rules.resize(2);
    drawing.rules[0].function[0].terms = {{2, 1.0f}};
    drawing.rules[1].function[0].terms = {{feature_of_field(2, true), 1.0f}};
    drawing.rules[1].function[1].terms = {{9, 0.7f}, {20, 0.3f}};
    Random random(seed + 1);
    drawing.samples.fields = OrientationFields(k_samples);
    for (std::size_t i = 0; i < k_samples; ++i) {
        const auto x = static_cast<std::uint16_t>(random.index(k_width)),
                   y = static_cast<std::uint16_t>(random.index(k_height));
        for (std::size_t k = 0; k < k_orientation_fields; ++k) drawing.samples.fields.field(k)[i] = fields.at(k, x, y);
        const std::uint32_t region = x < k_width / 2 ? 0 : 1;
        const bool crossed = region == 1 && y > k_height / 2;
        const std::size_t layer = crossed && random.uniform() < 0.4 ? 1 : 0;
        const float angle = angle_of(drawing.rules[region].function[layer].evaluate(drawing.samples.fields, i));
        drawing.samples.x.push_back(x);
        drawing.samples.y.push_back(y);
        drawing.samples.direction.push_back(doubled_angle(angle + static_cast<float>(noise * random.normal())));
        drawing.samples.level.push_back(crossed ? 2 : 1);
        drawing.samples.spacing.push_back(5);
        drawing.region.push_back(region);
    }
    return drawing;
}

/// Rule 0 hatches the left, rule 1 the right; both turn so much that their directions meet at places of the border.
Drawing two_turning_regions(double noise, std::uint64_t seed) {
    const SmoothFields fields(seed, 3);
    Drawing drawing;
    drawing.rules.resize(2);
    drawing.rules[0].function[0].terms = {{2, 1.0f}};
    drawing.rules[1].function[0].terms = {{9, 0.7f}, {20, 0.3f}};
    Random random(seed + 1);
    constexpr std::size_t k_few = 1500;
    drawing.samples.fields = OrientationFields(k_few);
    for (std::size_t i = 0; i < k_few; ++i) {
        const auto x = static_cast<std::uint16_t>(random.index(k_width)),
                   y = static_cast<std::uint16_t>(random.index(k_height));
        for (std::size_t k = 0; k < k_orientation_fields; ++k) drawing.samples.fields.field(k)[i] = fields.at(k, x, y);
        const std::uint32_t region = x < k_width / 2 ? 0 : 1;
        const float angle = angle_of(drawing.rules[region].function[0].evaluate(drawing.samples.fields, i));
        drawing.samples.x.push_back(x);
        drawing.samples.y.push_back(y);
        drawing.samples.direction.push_back(doubled_angle(angle + static_cast<float>(noise * random.normal())));
        drawing.samples.level.push_back(1);
        drawing.samples.spacing.push_back(8);
        drawing.region.push_back(region);
    }
    return drawing;
}

/// Mean difference of directions, in degrees, over the samples of a region, or its cross-hatched ones.
double mean_error(const OrientationFunction& learned, const OrientationFunction& truth, const Drawing& drawing,
                  std::uint32_t region, bool only_crossed = false) {
    double sum = 0, count = 0;
    for (std::size_t i = 0; i < drawing.region.size(); ++i) {
        if (drawing.region[i] != region || (only_crossed && drawing.samples.level[i] != 2)) continue;
        const float expected = angle_of(truth.evaluate(drawing.samples.fields, i));
        sum += static_cast<double>(
            orientation_difference(angle_of(learned.evaluate(drawing.samples.fields, i)), expected));
        count += 1;
    }
    return sum / count / k_degree;
}

TEST(OrientationMixture, FindsTwoRulesAndWhereTheyHold) {
    for (const std::uint64_t seed : {1u, 2u, 3u, 4u}) {
        SCOPED_TRACE(seed);
        const Drawing drawing = two_regions(3 * k_degree, seed);
        const OrientationMixture mixture = learn_mixture(drawing.samples);
        ASSERT_EQ(mixture.rules.size(), 2U);
        const std::uint32_t left = mixture.rules[0].crosses() ? 1 : 0, right = 1 - left;
        EXPECT_FALSE(mixture.rules[left].crosses());
        EXPECT_TRUE(mixture.rules[right].crosses());
        std::size_t correct = 0;
        for (std::size_t i = 0; i < k_samples; ++i) correct += (mixture.segment[i] == left) == (drawing.region[i] == 0);
        EXPECT_GE(correct, 0.97 * k_samples);
        EXPECT_LT(mean_error(mixture.rules[left].function[0], drawing.rules[0].function[0], drawing, 0), 1);
        EXPECT_LT(mean_error(mixture.rules[right].function[0], drawing.rules[1].function[0], drawing, 1), 1);
        // Where nothing crosses, nothing tells how it would.
        EXPECT_LT(mean_error(mixture.rules[right].function[1], drawing.rules[1].function[1], drawing, 1, true), 1);
        EXPECT_NEAR(mixture.share[0], 0.5, 0.03);
        EXPECT_NEAR(mixture.share[0] + mixture.share[1], 1, 1e-6);
        EXPECT_GE(mixture.share[0], mixture.share[1]);
        // |u - f|^2 of vectors of doubled angle, (2 noise)^2; and up to 4 of each of the few samples on the border that
        // the medians around them put on the wrong side.
        EXPECT_GT(mixture.error, 0.009);
        EXPECT_LT(mixture.error, 0.018);
    }
}

// Without a gate by place, half of one region goes to the other's rule on most of these, and six in ten are right.
TEST(OrientationMixture, TellsRegionsApartWhoseDirectionsMeet) {
    std::size_t right = 0, all = 0;
    for (const std::uint64_t seed : {1u, 2u, 3u, 4u, 5u, 6u, 7u, 8u}) {
        const Drawing drawing = two_turning_regions(10 * k_degree, seed);
        const OrientationMixture mixture = learn_mixture(drawing.samples);
        EXPECT_LE(mixture.rules.size(), 3U) << "of picture " << seed;
        std::vector<std::array<std::size_t, 2>> samples_of(mixture.rules.size());  // by region
        for (std::size_t i = 0; i < drawing.region.size(); ++i) ++samples_of[mixture.segment[i]][drawing.region[i]];
        for (const auto& regions : samples_of) right += std::max(regions[0], regions[1]);
        all += drawing.region.size();
    }
    EXPECT_GE(static_cast<double>(right), 0.93 * static_cast<double>(all));
}

// One rule that turns by more than clusters do is one rule.
TEST(OrientationMixture, OneRuleIsOneSegment) {
    Drawing drawing = two_regions(0, 5);
    Random random(6);
    for (std::size_t i = 0; i < k_samples; ++i) {
        drawing.samples.level[i] = 1;
        for (std::size_t k = 0; k < k_orientation_fields; ++k) {
            // Around the middle of the picture.
            const double turn = std::atan2(drawing.samples.y[i] - 80, drawing.samples.x[i] - 120);
            const DoubledAngle v = drawing.samples.fields.field(k)[i];
            drawing.samples.fields.field(k)[i] = doubled_angle(angle_of(v) + static_cast<float>(turn));
        }
        const DoubledAngle v = drawing.samples.fields.feature(4, i);
        drawing.samples.direction[i] = doubled_angle(angle_of(v) + static_cast<float>(0.05 * random.normal()));
    }
    const OrientationMixture mixture = learn_mixture(drawing.samples);
    ASSERT_EQ(mixture.rules.size(), 1U);
    EXPECT_FALSE(mixture.rules[0].crosses());
    EXPECT_EQ(mixture.segment, std::vector<std::uint32_t>(k_samples, 0));
    EXPECT_LT(mean_error(mixture.rules[0].function[0], OrientationFunction{{{4, 1.0f}}}, drawing, 0), 1);
}

TEST(OrientationMixture, IsDeterministic) {
    const Drawing drawing = two_regions(0.05, 4);
    const OrientationMixture first = learn_mixture(drawing.samples);
    const ThreadLimit one(1);
    const OrientationMixture again = learn_mixture(drawing.samples);
    EXPECT_EQ(again.rules, first.rules);
    EXPECT_EQ(again.segment, first.segment);
    EXPECT_EQ(again.share, first.share);
    EXPECT_EQ(again.error, first.error);
}

TEST(OrientationMixture, OfNoSamplesHasNoRules) {
    const OrientationSamples none;
    EXPECT_TRUE(learn_mixture(none).rules.empty());
}

}  // namespace
}  // namespace exemplar
