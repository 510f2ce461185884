#include "host/hatching/style/familiarity.h"

#include <gtest/gtest.h>

#include <numeric>

#include "host/core/errors.h"
#include "host/core/random.h"
#include "host/hatching/features/pixel_features.h"

namespace exemplar {
namespace {

/// Pixels whose features lie around `middle`.
FeatureMatrix pixels_around(float middle, std::size_t count, std::uint64_t seed) {
    Random random(seed);
    FeatureMatrix features;
    features.rows = count;
    for (const std::string& name : pixel_feature_names())
        for (float& value : features.add(name)) value = middle + static_cast<float>(random.uniform(-1, 1));
    return features;
}

std::vector<std::uint32_t> numbers_of_all_features() {
    std::vector<std::uint32_t> which(k_pixel_features);
    std::iota(which.begin(), which.end(), 0U);
    return which;
}

float mean_of(const std::vector<float>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0f) / static_cast<float>(values.size());
}

Familiarity learned() {
    const FeatureMatrix drawing = pixels_around(0, 1500, 1);
    std::vector<std::uint8_t> held(drawing.rows);
    for (std::size_t i = 0; i < held.size(); ++i) held[i] = i % 4 == 0 ? 1 : 0;
    return learn_familiarity(drawing, held, 7);
}

TEST(Familiarity, IsThatOfPixelsLikeTheDrawings) {
    const Familiarity familiarity = learned();
    EXPECT_GT(familiarity.reach, 0);
    EXPECT_EQ(familiarity, learned());
    const float same = mean_of(familiarity.of(numbers_of_all_features(), pixels_around(0, 1500, 1)));
    const float alike = mean_of(familiarity.of(numbers_of_all_features(), pixels_around(0, 400, 2)));
    EXPECT_GT(same, alike);
    EXPECT_GT(alike, 0.6f);
    float before = alike;
    for (const float away : {0.7f, 1.4f, 3.0f}) {
        const float other = mean_of(familiarity.of(numbers_of_all_features(), pixels_around(away, 400, 3)));
        EXPECT_LT(other, before) << away;
        before = other;
    }
    EXPECT_LT(before, 0.01f);
}

TEST(Familiarity, WithoutSamplesEverythingIsFamiliar) {
    const FeatureMatrix pixels = pixels_around(50, 10, 1);
    EXPECT_EQ(Familiarity{}.of(numbers_of_all_features(), pixels), std::vector<float>(10, 1.0f));
}

TEST(Familiarity, AFeatureThatWasNotMeasuredIsNamed) {
    const std::vector<std::uint32_t> none;
    EXPECT_THROW(learned().of(none, FeatureMatrix{5, {}, {}}), UsageError);
}

TEST(Familiarity, ItsFeaturesExist) {
    for (const std::uint32_t feature : familiar_features()) EXPECT_LT(feature, k_pixel_features);
}

}  // namespace
}  // namespace exemplar
