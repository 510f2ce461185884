#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "gpu/learn/stump_scorer.h"
#include "host/core/errors.h"
#include "host/core/random.h"
#include "host/learn/boosted_stumps.h"
#include "tests/gpu/support/environment.h"

// The device sums the stumps of each set of classes apart, so sums round differently; H stays below about 30 here,
// where a float's spacing is 2e-6, and exp adds a few units in the last place. Probabilities weaken the error of H at
// least fourfold.
namespace exemplar {
namespace {

constexpr float k_tolerance = 1e-5f;

FeatureMatrix random_features(std::size_t rows, std::size_t columns, Random& random) {
    FeatureMatrix features;
    features.rows = rows;
    for (std::size_t c = 0; c < columns; ++c)
        for (float& value : features.add("test." + std::to_string(c))) {
            value = static_cast<float>(random.normal());
            if (random.uniform() < 0.02) value = std::numeric_limits<float>::quiet_NaN();
            if (random.uniform() < 0.02) value = std::numeric_limits<float>::infinity();
            if (random.uniform() < 0.02) value = -std::numeric_limits<float>::infinity();
        }
    return features;
}

BoostedStumps random_stumps(std::uint32_t classes, std::size_t count, std::size_t columns, Random& random) {
    BoostedStumps result;
    result.class_count = classes;
    const std::uint64_t all = classes == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << classes) - 1;
    for (std::size_t m = 0; m < count; ++m) {
        // A few sets come again and again, as in trained classifiers.
        const std::uint64_t set =
            random.uniform() < 0.5 ? (random.next() & all) : (std::uint64_t{1} << random.index(classes));
        result.stumps.push_back({static_cast<std::uint32_t>(random.index(columns)), static_cast<float>(random.normal()),
                                 static_cast<float>(random.uniform(-0.3, 0.3)),
                                 static_cast<float>(random.uniform(-0.3, 0.3)), set});
        for (std::uint32_t c = 0; c < classes; ++c)
            result.elsewhere.push_back(set >> c & 1 ? 0.0f : static_cast<float>(random.uniform(-0.1, 0.1)));
    }
    return result;
}

void expect_parity(StumpScorer& device, const BoostedStumps& classifier, const FeatureMatrix& features, Link link,
                   float scale) {
    std::vector<float> expected(features.rows * classifier.class_count), actual(expected.size(), -1.0f);
    CpuStumpScorer().probabilities(classifier, features, link, scale, expected);
    device.probabilities(classifier, features, link, scale, actual);
    for (std::size_t i = 0; i < expected.size(); ++i)
        ASSERT_NEAR(actual[i], expected[i], k_tolerance)
            << "item " << i / classifier.class_count << ", class " << i % classifier.class_count;
}

TEST(StumpParity, OddNumbersOfRows) {
    GpuStumpScorer scorer(testing::shared_device());
    Random random(1);
    for (const std::size_t rows : {0u, 1u, 3u, 63u, 64u, 65u, 255u, 256u, 257u, 1003u}) {
        SCOPED_TRACE(rows);
        const FeatureMatrix features = random_features(rows, 30, random);
        expect_parity(scorer, random_stumps(5, 100, 30, random), features, Link::softmax, 1.0f);
    }
}

TEST(StumpParity, OddNumbersOfClasses) {
    GpuStumpScorer scorer(testing::shared_device());
    Random random(2);
    const FeatureMatrix features = random_features(70, 20, random);
    for (const std::uint32_t classes : {1u, 3u, 4u, 5u, 8u, 17u, 33u})
        for (const Link link : {Link::softmax, Link::sigmoid}) {
            SCOPED_TRACE(classes);
            expect_parity(scorer, random_stumps(classes, 60, 20, random), features, link, 2.0f);
        }
}

TEST(StumpParity, TheMostClasses) {
    GpuStumpScorer scorer(testing::shared_device());
    Random random(8);
    const FeatureMatrix features = random_features(70, 20, random);
    expect_parity(scorer, random_stumps(64, 60, 20, random), features, Link::softmax, 2.0f);
}

TEST(StumpParity, ClassifiersOfAnyLength) {
    GpuStumpScorer scorer(testing::shared_device());
    Random random(3);
    const FeatureMatrix features = random_features(130, 40, random);
    for (const std::size_t stumps : {0u, 1u, 2u, 300u}) {
        SCOPED_TRACE(stumps);
        expect_parity(scorer, random_stumps(6, stumps, 40, random), features, Link::softmax, 1.0f);
    }
}

TEST(StumpParity, RowsAreTiledToTheLimit) {
    Random random(4);
    const FeatureMatrix features = random_features(1001, 25, random);
    const BoostedStumps classifier = random_stumps(7, 90, 25, random);
    for (const std::size_t tile_bytes : {1u, 2000u, 25u * 4u * 64u, 50'000u}) {
        GpuStumpScorer scorer(testing::shared_device(), nullptr, tile_bytes);
        SCOPED_TRACE(tile_bytes);
        expect_parity(scorer, classifier, features, Link::softmax, 1.0f);
    }
}

// All sums are multiples of 1/64 below 2^11, which floats hold exactly, in any order.
TEST(StumpParity, LargeScoresStayFinite) {
    GpuStumpScorer scorer(testing::shared_device());
    Random random(5);
    const FeatureMatrix features = random_features(65, 10, random);
    BoostedStumps classifier = random_stumps(4, 20, 10, random);
    for (Stump& stump : classifier.stumps) {
        stump.above = stump.above > 0.0f ? 64.0f : -64.0f;
        stump.below = std::round(64.0f * stump.below) / 64.0f;
    }
    for (float& constant : classifier.elsewhere) constant = std::round(64.0f * constant) / 64.0f;
    for (const Link link : {Link::softmax, Link::sigmoid}) expect_parity(scorer, classifier, features, link, 4.0f);
}

// Reruns on one device are equal bit for bit.
TEST(StumpParity, IsDeterministic) {
    GpuStumpScorer scorer(testing::shared_device());
    Random random(6);
    const FeatureMatrix features = random_features(500, 10, random);
    const BoostedStumps classifier = random_stumps(6, 50, 10, random);
    std::vector<float> first(500 * 6), second(500 * 6);
    scorer.probabilities(classifier, features, Link::sigmoid, 1.0f, first);
    scorer.probabilities(classifier, features, Link::sigmoid, 1.0f, second);
    EXPECT_EQ(first, second);
}

TEST(StumpParity, RefusesWhatTheReferenceRefuses) {
    GpuStumpScorer gpu(testing::shared_device());
    CpuStumpScorer cpu;
    Random random(7);
    const FeatureMatrix features = random_features(10, 5, random);
    const BoostedStumps good = random_stumps(3, 4, 5, random);
    BoostedStumps missing = good, beyond = good, none = good;
    missing.stumps[2].feature = 5;
    beyond.stumps[1].classes = 8;
    none.class_count = 0;
    std::vector<float> out(30), small(29);
    for (StumpScorer* scorer : std::initializer_list<StumpScorer*>{&gpu, &cpu}) {
        EXPECT_THROW(scorer->probabilities(missing, features, Link::softmax, 1.0f, out), ModelError);
        EXPECT_THROW(scorer->probabilities(beyond, features, Link::softmax, 1.0f, out), ModelError);
        EXPECT_THROW(scorer->probabilities(none, features, Link::softmax, 1.0f, out), ModelError);
        EXPECT_THROW(scorer->probabilities(good, features, Link::softmax, 1.0f, small), UsageError);
        EXPECT_THROW(scorer->probabilities(good, features, Link::softmax, 0.0f, out), UsageError);
    }
}

}  // namespace
}  // namespace exemplar
