#include "host/learn/boosting/threshold_ranks.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "host/core/random.h"

namespace exemplar {
namespace {

constexpr float k_infinite = std::numeric_limits<float>::infinity(), k_nan = std::numeric_limits<float>::quiet_NaN();

TEST(ThresholdRanks, ThresholdsAreByFeatureEachOnce) {
    const std::vector<Stump> stumps{{7, 0.5F, 0, 0, 1}, {2, 3, 0, 0, 1},    {7, -1, 0, 0, 2},
                                    {7, 0.5F, 0, 0, 2}, {2, 0.0F, 0, 0, 1}, {2, -0.0F, 0, 0, 1}};
    const std::vector<FeatureThresholds> features = thresholds_of(stumps);
    ASSERT_EQ(features.size(), 2U);
    EXPECT_EQ(features[0].feature, 2U);
    EXPECT_EQ(features[0].thresholds, (std::vector<float>{0, 3}));
    EXPECT_EQ(features[1].feature, 7U);
    EXPECT_EQ(features[1].thresholds, (std::vector<float>{-1, 0.5F}));
    EXPECT_EQ(features[0].index_of(-0.0F), 0U);
    EXPECT_EQ(features[1].index_of(0.5F), 1U);
    EXPECT_TRUE(thresholds_of({}).empty());
}

template <typename Rank>
std::vector<Rank> ranks_of(const std::vector<float>& values, const std::vector<float>& thresholds) {
    std::vector<Rank> ranks(values.size(), Rank{99});
    rank(values, thresholds, std::span(ranks));
    return ranks;
}

// Exactly where value > threshold, so also of what is no number, and of neighbors of a threshold.
template <typename Rank>
void expect_the_same_answers(const std::vector<float>& values, const std::vector<float>& thresholds) {
    const std::vector<Rank> ranks = ranks_of<Rank>(values, thresholds);
    for (std::size_t v = 0; v < values.size(); ++v)
        for (std::size_t t = 0; t < thresholds.size(); ++t)
            ASSERT_EQ(ranks[v] > t, values[v] > thresholds[t]) << values[v] << " and " << thresholds[t];
}

// At the thresholds, just beside them, and beyond all.
std::vector<float> values_around(const std::vector<float>& thresholds) {
    std::vector<float> values{k_nan, -k_nan, k_infinite, -k_infinite, 0.0F, -0.0F, 1e-45F, -1e-45F};
    for (const float threshold : thresholds)
        for (const float value :
             {threshold, std::nextafter(threshold, k_infinite), std::nextafter(threshold, -k_infinite)})
            values.push_back(value);
    return values;
}

TEST(ThresholdRanks, AnswerAsTheValuesDo) {
    constexpr float k_largest = std::numeric_limits<float>::max();
    for (const std::vector<float>& thresholds :
         {std::vector<float>{}, {0}, {-k_largest, -1, 0, 1e-45F, 1, k_largest}, {-k_infinite, 2, k_infinite}}) {
        expect_the_same_answers<std::uint8_t>(values_around(thresholds), thresholds);
        expect_the_same_answers<std::uint16_t>(values_around(thresholds), thresholds);
    }
}

// Compared with each, or searched.
TEST(ThresholdRanks, AnswerAsTheValuesDoOfManyThresholds) {
    Random random(1);
    for (const std::size_t count : {127U, 128U, 129U, 255U, 256U, 1000U}) {
        std::vector<Stump> stumps;
        for (std::size_t i = 0; i < count; ++i) stumps.push_back({0, static_cast<float>(random.normal()), 0, 0, 1});
        const std::vector<float> thresholds = thresholds_of(stumps)[0].thresholds;
        if (thresholds.size() < 256) expect_the_same_answers<std::uint8_t>(values_around(thresholds), thresholds);
        expect_the_same_answers<std::uint16_t>(values_around(thresholds), thresholds);
    }
}

// From the middle of the type's range on they are in order as signed numbers, of as many thresholds as a byte counts.
TEST(ThresholdRanks, CountFromTheLowest) {
    for (const std::size_t count : {3U, 128U, 255U}) {
        std::vector<float> thresholds, values;
        for (std::size_t i = 0; i < count; ++i) thresholds.push_back(static_cast<float>(i));
        for (std::size_t i = 0; i <= count; ++i) values.push_back(static_cast<float>(i) - 0.5F);
        std::vector<std::uint8_t> ranks(values.size());
        rank(values, thresholds, std::span(ranks), 128);
        for (std::size_t i = 0; i < ranks.size(); ++i)
            ASSERT_EQ(static_cast<std::int8_t>(ranks[i]), static_cast<int>(i) - 128) << count;
    }
}

TEST(ThresholdRanks, MergedListsHaveTheThresholdsOfAll) {
    const std::vector<std::vector<FeatureThresholds>> lists{{{2, {1, 3}}, {5, {0}}}, {}, {{2, {2, 3}}, {4, {7}}}};
    const std::vector<FeatureThresholds> all = merged(lists);
    ASSERT_EQ(all.size(), 3U);
    EXPECT_EQ(all[0].feature, 2U);
    EXPECT_EQ(all[0].thresholds, (std::vector<float>{1, 2, 3}));
    EXPECT_EQ(all[1].feature, 4U);
    EXPECT_EQ(all[2].thresholds, (std::vector<float>{0}));
}

TEST(ThresholdRanks, AnyNumberOfValues) {
    EXPECT_TRUE(ranks_of<std::uint8_t>({}, {1, 2}).empty());
    for (const std::size_t count : {1U, 511U, 512U, 513U, 1500U}) {
        std::vector<float> values(count, 1.5F);
        values.back() = 3;
        std::vector<std::uint8_t> expected(count, 1);
        expected.back() = 2;
        EXPECT_EQ(ranks_of<std::uint8_t>(values, {1, 2}), expected);
    }
}

}  // namespace
}  // namespace exemplar
