#include "host/learn/boosting/quantize.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "host/core/errors.h"
#include "host/core/parallel.h"
#include "host/core/random.h"

namespace exemplar {
namespace {

constexpr float k_infinity = std::numeric_limits<float>::infinity();

FeatureMatrix matrix_of(const std::vector<std::vector<float>>& columns) {
    FeatureMatrix matrix;
    matrix.rows = columns.front().size();
    for (const std::vector<float>& column : columns) {
        std::copy(column.begin(), column.end(), matrix.add(fmt::format("f{}", matrix.cols())).begin());
    }
    return matrix;
}

std::vector<float> smooth_values(std::size_t count, Random& random) {
    std::vector<float> values(count);
    for (float& value : values) value = static_cast<float>(random.normal());
    return values;
}

/// The contract: `bin > t` exactly where `value > thresholds[t]`.
void expect_bins_match_floats(const FeatureMatrix& matrix, const QuantizedFeatures& quantized) {
    for (std::size_t f = 0; f < matrix.cols(); ++f) {
        const std::vector<float>& thresholds = quantized.thresholds[f];
        EXPECT_TRUE(std::is_sorted(thresholds.begin(), thresholds.end()));
        EXPECT_EQ(std::adjacent_find(thresholds.begin(), thresholds.end()), thresholds.end());
        for (std::size_t i = 0; i < matrix.rows; ++i) {
            for (std::size_t t = 0; t < thresholds.size(); ++t) {
                ASSERT_EQ(quantized.column(f)[i] > t, matrix.column(f)[i] > thresholds[t])
                    << matrix.column(f)[i] << " " << thresholds[t];
            }
        }
    }
}

TEST(Quantize, BinsReproduceFloatComparisons) {
    Random random(1);
    std::vector<float> smooth = smooth_values(3000, random), coarse(3000), odd(3000), tiny(3000);
    const std::vector<float> specials{-k_infinity,
                                      k_infinity,
                                      std::nanf(""),
                                      -0.0f,
                                      0.0f,
                                      1e-45f,
                                      std::numeric_limits<float>::max(),
                                      -std::numeric_limits<float>::max()};
    for (std::size_t i = 0; i < 3000; ++i) {
        coarse[i] = static_cast<float>(random.index(40));
        odd[i] = random.uniform() < 0.5 ? specials[random.index(specials.size())] : smooth[i];
        tiny[i] = std::nextafter(1.0f, 2.0f) * (random.index(2) != 0 ? 1.0f : 1.0f / std::nextafter(1.0f, 2.0f));
    }
    const FeatureMatrix matrix = matrix_of({smooth, coarse, odd, tiny});
    for (const std::size_t bins : {2u, 3u, 7u, 128u, 255u, 256u}) {
        const QuantizedFeatures quantized = quantize(matrix, {}, {bins});
        expect_bins_match_floats(matrix, quantized);
        for (const std::vector<float>& thresholds : quantized.thresholds) EXPECT_LT(thresholds.size(), bins);
    }
}

TEST(Quantize, KeepsDistinctValuesApartWhenTheyFit) {
    const std::vector<float> values{3, 1, 2, 2, 1, 3, 3, 8};
    EXPECT_EQ(quantile_thresholds(values, {}, 4), (std::vector<float>{1.5f, 2.5f, 5.5f}));
    EXPECT_EQ(quantile_thresholds(values, {}, 256), (std::vector<float>{1.5f, 2.5f, 5.5f}));
    const float next = std::nextafter(1.0f, 2.0f);
    const std::vector<float> neighbors{next, 1.0f};
    EXPECT_EQ(quantile_thresholds(neighbors, {}, 8), (std::vector<float>{1.0f}));
}

TEST(Quantize, HasNoThresholdForAConstantOrMissingFeature) {
    const std::vector<float> constant(5, 2.0f), missing(5, std::nanf("")), zeros{0.0f, -0.0f, 0.0f};
    EXPECT_TRUE(quantile_thresholds(constant, {}, 8).empty());
    EXPECT_TRUE(quantile_thresholds(missing, {}, 8).empty());
    EXPECT_TRUE(quantile_thresholds(zeros, {}, 8).empty());
    EXPECT_TRUE(quantile_thresholds({}, {}, 8).empty());
}

TEST(Quantize, BinsHoldEqualWeight) {
    Random random(2);
    const std::vector<float> values = smooth_values(20000, random);
    std::vector<float> weights(values.size());
    for (std::size_t i = 0; i < values.size(); ++i) weights[i] = values[i] > 0.0f ? 9.0f : 1.0f;
    const std::vector<float> thresholds = quantile_thresholds(values, weights, 20);
    ASSERT_EQ(thresholds.size(), 19u);
    std::vector<double> in_bin(20, 0.0);
    double all = 0.0;
    for (std::size_t i = 0; i < values.size(); ++i) {
        const auto above = std::upper_bound(thresholds.begin(), thresholds.end(), values[i]) - thresholds.begin();
        in_bin[static_cast<std::size_t>(above)] += weights[i];
        all += weights[i];
    }
    for (const double weight : in_bin) EXPECT_NEAR(weight / all, 1.0 / 20, 0.002);
}

TEST(Quantize, AFrequentValueLeavesTheOthersDivided) {
    Random random(3);
    std::vector<float> values = smooth_values(10000, random);
    for (std::size_t i = 0; i < 9000; ++i) values[i] = 0.0f;
    const std::vector<float> thresholds = quantile_thresholds(values, {}, 32);
    EXPECT_GE(thresholds.size(), 16u);
    EXPECT_LT(thresholds.size(), 32u);
    // Zero has a bin (nearly) of its own.
    const auto after = std::upper_bound(thresholds.begin(), thresholds.end(), 0.0f);
    ASSERT_NE(after, thresholds.end());
    EXPECT_LT(*after, 0.05f);
}

TEST(Quantize, SamplesRowsOfLargeSets) {
    Random random(4);
    const FeatureMatrix matrix = matrix_of({smooth_values(5000, random), smooth_values(5000, random)});
    const QuantizedFeatures sampled = quantize(matrix, {}, {64, 1000});
    expect_bins_match_floats(matrix, sampled);
    EXPECT_EQ(sampled.thresholds[0].size(), 63u);
    for (std::size_t bin = 0; bin < 64; ++bin) {
        const auto count = std::count(sampled.column(0).begin(), sampled.column(0).end(), bin);
        EXPECT_NEAR(static_cast<double>(count), 5000.0 / 64, 60.0);
    }
}

TEST(Quantize, DoesNotDependOnThreads) {
    Random random(6);
    const FeatureMatrix matrix = matrix_of(std::vector<std::vector<float>>(9, smooth_values(2000, random)));
    const QuantizedFeatures many = quantize(matrix, {}, {});
    const ThreadLimit one(1);
    const QuantizedFeatures single = quantize(matrix, {}, {});
    EXPECT_EQ(many.bins, single.bins);
    EXPECT_EQ(many.thresholds, single.thresholds);
}

TEST(Quantize, RefusesBadOptions) {
    const FeatureMatrix matrix = matrix_of({{1.0f, 2.0f}});
    EXPECT_THROW(quantize(matrix, {}, {1}), UsageError);
    EXPECT_THROW(quantize(matrix, {}, {257}), UsageError);
    const std::vector<float> weights{1.0f};
    EXPECT_THROW(quantize(matrix, weights, {}), UsageError);
}

}  // namespace
}  // namespace exemplar
