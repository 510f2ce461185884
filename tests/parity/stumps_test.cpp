#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "gpu/learn/stump_scorer.h"
#include "gpu/runtime/vulkan/errors.h"
#include "host/core/errors.h"
#include "host/core/random.h"
#include "host/learn/boosting/boosted_stumps.h"
#include "tests/gpu/support/environment.h"

// The device sums the stumps of each set of classes apart, so sums round differently; H stays below about 30 here,
// where a float's spacing is 2e-6, and exp adds a few units in the last place. Probabilities weaken the error of H at
// least fourfold.
namespace exemplar {
namespace {

constexpr float k_stumps_tolerance = 1e-5f;

FeatureMatrix random_stump_features(std::size_t rows, std::size_t columns, Random& random) {
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

void expect_stumps_parity(StumpScorer& device, const BoostedStumps& classifier, const FeatureMatrix& features,
                          Link link, float scale) {
    std::vector<float> expected(features.rows * classifier.class_count), actual(expected.size(), -1.0f);
    CpuStumpScorer().probabilities(classifier, features, link, scale, expected);
    device.probabilities(classifier, features, link, scale, actual);
    for (std::size_t i = 0; i < expected.size(); ++i)
        ASSERT_NEAR(actual[i], expected[i], k_stumps_tolerance)
            << "item " << i / classifier.class_count << ", class " << i % classifier.class_count;
}

// A scorer of features of so many bits.
std::unique_ptr<GpuStumpScorer> scorer_of_bits(std::uint32_t bits, std::uint32_t from_storage = 0,
                                               std::size_t tile_bytes = std::size_t{1} << 28,
                                               Profiler* profiler = nullptr) {
    Device& device = test_support::shared_device();
    const Tuning kept = device.tuning();
    device.tuning().set("learn/stumps.comp", "bits", bits);
    device.tuning().set("learn/stumps.comp", "storage", from_storage);
    auto scorer = std::make_unique<GpuStumpScorer>(device, profiler, tile_bytes);
    device.tuning() = kept;
    return scorer;
}

TEST(StumpParity, OddNumbersOfRows) {
    GpuStumpScorer scorer(test_support::shared_device());
    Random random(1);
    for (const std::size_t rows : {0u, 1u, 3u, 63u, 64u, 65u, 255u, 256u, 257u, 1003u}) {
        SCOPED_TRACE(rows);
        const FeatureMatrix features = random_stump_features(rows, 30, random);
        expect_stumps_parity(scorer, random_stumps(5, 100, 30, random), features, Link::softmax, 1.0f);
    }
}

TEST(StumpParity, OddNumbersOfClasses) {
    GpuStumpScorer scorer(test_support::shared_device());
    Random random(2);
    const FeatureMatrix features = random_stump_features(70, 20, random);
    for (const std::uint32_t classes : {1u, 3u, 4u, 5u, 8u, 17u, 33u})
        for (const Link link : {Link::softmax, Link::sigmoid}) {
            SCOPED_TRACE(classes);
            expect_stumps_parity(scorer, random_stumps(classes, 60, 20, random), features, link, 2.0f);
        }
}

// Features that are in a buffer already, in columns of their own numbers.
TEST(StumpParity, FeaturesOnTheDevice) {
    Device& device = test_support::shared_device();
    GpuStumpScorer scorer(device);
    Random random(21);
    for (const std::size_t rows : {1u, 255u, 256u, 1003u}) {
        SCOPED_TRACE(rows);
        FeatureMatrix features = random_stump_features(rows, 30, random);
        for (float& value : features.values)
            if (!std::isfinite(value)) value = 0;
        const BoostedStumps classifier = random_stumps(5, 60, 30, random);
        std::vector<float> expected(rows * 5), actual(rows * 5);
        CpuStumpScorer().probabilities(classifier, features, Link::softmax, 1, expected);
        const std::size_t stride = (rows + 255) / 256 * 256;
        std::vector<float> columns(30 * stride);
        for (std::size_t c = 0; c < 30; ++c)
            std::ranges::copy(features.column(c), columns.begin() + static_cast<std::ptrdiff_t>(c * stride));
        const Buffer input = Buffer::of<float>(device, columns), output(device, 5 * stride * sizeof(float));
        Stream stream(device);
        scorer.record(stream, classifier, Link::softmax, 1, input, rows, stride, output);
        stream.fetch<float>(output, actual);
        for (std::size_t i = 0; i < expected.size(); ++i) ASSERT_NEAR(actual[i], expected[i], k_stumps_tolerance) << i;
        for (const std::size_t wrong : {stride - 1, stride / 2, 2 * stride})
            EXPECT_THROW(scorer.record(stream, classifier, Link::softmax, 1, input, rows, wrong, output), UsageError);
    }
}

TEST(StumpParity, TheMostClasses) {
    GpuStumpScorer scorer(test_support::shared_device());
    Random random(8);
    const FeatureMatrix features = random_stump_features(70, 20, random);
    expect_stumps_parity(scorer, random_stumps(64, 60, 20, random), features, Link::softmax, 2.0f);
}

// A group of stumps runs through all of its classes, so that few stumps of many classes take many iterations as well.
TEST(StumpParity, MoreSetsOfClassesThanADispatchTakes) {
    GpuStumpScorer scorer(test_support::shared_device());
    Random random(17);
    const FeatureMatrix features = random_stump_features(70, 20, random);
    for (const std::size_t count : {900u, 5000u})
        for (const Link link : {Link::softmax, Link::sigmoid})
            expect_stumps_parity(scorer, random_stumps(60, count, 20, random), features, link, 0.5f);
}

TEST(StumpParity, ClassifiersOfAnyLength) {
    GpuStumpScorer scorer(test_support::shared_device());
    Random random(3);
    const FeatureMatrix features = random_stump_features(130, 40, random);
    for (const std::size_t stumps : {0u, 1u, 2u, 300u}) {
        SCOPED_TRACE(stumps);
        expect_stumps_parity(scorer, random_stumps(6, stumps, 40, random), features, Link::softmax, 1.0f);
    }
}

// The device asks once where several stumps ask the same.
TEST(StumpParity, RepeatedStumpsCountAsOftenAsTheyCome) {
    GpuStumpScorer scorer(test_support::shared_device());
    Random random(13);
    const FeatureMatrix features = random_stump_features(130, 10, random);
    std::vector<BoostedStumps> classifiers(4, random_stumps(5, 80, 10, random));
    for (BoostedStumps& classifier : classifiers)
        for (Stump& stump : classifier.stumps) {
            stump.threshold = std::round(2.0f * stump.threshold) / 2.0f;
            stump.above += static_cast<float>(random.uniform(-0.2, 0.2));
            stump.below += static_cast<float>(random.uniform(-0.2, 0.2));
        }
    expect_stumps_parity(scorer, mean_classifier(classifiers), features, Link::softmax, 2.0f);
}

TEST(StumpParity, RowsAreTiledToTheLimit) {
    Random random(4);
    const FeatureMatrix features = random_stump_features(1001, 25, random);
    const BoostedStumps classifier = random_stumps(7, 90, 25, random);
    for (const std::size_t tile_bytes : {1u, 2000u, 25u * 4u * 64u, 50'000u}) {
        GpuStumpScorer scorer(test_support::shared_device(), nullptr, tile_bytes);
        SCOPED_TRACE(tile_bytes);
        expect_stumps_parity(scorer, classifier, features, Link::softmax, 1.0f);
    }
}

// All sums are multiples of 1/64 below 2^11, which floats hold exactly, in any order.
TEST(StumpParity, LargeScoresStayFinite) {
    GpuStumpScorer scorer(test_support::shared_device());
    Random random(5);
    const FeatureMatrix features = random_stump_features(65, 10, random);
    BoostedStumps classifier = random_stumps(4, 20, 10, random);
    for (Stump& stump : classifier.stumps) {
        stump.above = stump.above > 0.0f ? 64.0f : -64.0f;
        stump.below = std::round(64.0f * stump.below) / 64.0f;
    }
    for (float& constant : classifier.elsewhere) constant = std::round(64.0f * constant) / 64.0f;
    for (const Link link : {Link::softmax, Link::sigmoid})
        expect_stumps_parity(scorer, classifier, features, link, 4.0f);
}

// Reruns on one device are equal bit for bit.
TEST(StumpParity, IsDeterministic) {
    GpuStumpScorer scorer(test_support::shared_device());
    Random random(6);
    const FeatureMatrix features = random_stump_features(500, 10, random);
    const BoostedStumps classifier = random_stumps(6, 50, 10, random);
    std::vector<float> first(500 * 6), second(500 * 6);
    scorer.probabilities(classifier, features, Link::sigmoid, 1.0f, first);
    scorer.probabilities(classifier, features, Link::sigmoid, 1.0f, second);
    EXPECT_EQ(first, second);
}

struct Group {
    std::vector<FeatureMatrix> features;
    std::vector<std::vector<float>> out;

    Group(const std::vector<std::size_t>& rows, std::size_t columns, std::uint32_t classes, Random& random) {
        for (const std::size_t count : rows) {
            features.push_back(random_stump_features(count, columns, random));
            out.emplace_back(count * classes, -1.0f);
        }
    }
    std::vector<ScoredMatrix> matrices() {
        std::vector<ScoredMatrix> result;
        for (std::size_t i = 0; i < features.size(); ++i) result.push_back({&features[i], out[i]});
        return result;
    }
};

void expect_as_one_by_one(StumpScorer& scorer, const BoostedStumps& classifier, Group group) {
    scorer.probabilities_of_all(classifier, Link::sigmoid, 1.5f, group.matrices());
    for (std::size_t i = 0; i < group.features.size(); ++i) {
        SCOPED_TRACE("matrix " + std::to_string(i));
        std::vector<float> alone(group.out[i].size());
        scorer.probabilities(classifier, group.features[i], Link::sigmoid, 1.5f, alone);
        EXPECT_EQ(group.out[i], alone);
        expect_stumps_parity(scorer, classifier, group.features[i], Link::sigmoid, 1.5f);
    }
}

// With the least limit a tile has 128 rows on a CPU, 32 on a GPU.
TEST(StumpParity, MatricesOfAGroupAreScoredAsOneByOne) {
    Random random(9);
    const BoostedStumps classifier = random_stumps(5, 100, 30, random);
    const std::vector<std::size_t> sizes{0, 1, 31, 32, 33, 0, 127, 128, 129, 3, 1003, 0};
    for (const std::size_t tile_bytes : {std::size_t{1}, std::size_t{30} * 4 * 300, std::size_t{1} << 28}) {
        SCOPED_TRACE(tile_bytes);
        GpuStumpScorer scorer(test_support::shared_device(), nullptr, tile_bytes);
        expect_as_one_by_one(scorer, classifier, Group(sizes, 30, 5, random));
        for (const std::size_t only : {0u, 127u, 128u, 129u})
            expect_as_one_by_one(scorer, classifier, Group({only}, 30, 5, random));
        expect_as_one_by_one(scorer, classifier, Group({}, 30, 5, random));
    }
    CpuStumpScorer reference;
    expect_as_one_by_one(reference, classifier, Group(sizes, 30, 5, random));
}

TEST(StumpParity, ManyMatricesAreOneSubmission) {
    Random random(10);
    Profiler profiler;
    GpuStumpScorer scorer(test_support::shared_device(), &profiler);
    std::vector<std::size_t> sizes(200);
    for (std::size_t& size : sizes) size = random.index(40);
    Group group(sizes, 20, 4, random);
    for (const std::size_t stumps : {50u, 300u}) {
        const BoostedStumps classifier = random_stumps(4, stumps, 20, random);
        profiler.reset();
        scorer.probabilities_of_all(classifier, Link::sigmoid, 1.5f, group.matrices());
        EXPECT_EQ(profiler.submissions(), 1u);
        expect_as_one_by_one(scorer, classifier, group);
    }
    Group none({0, 0, 0}, 20, 4, random);
    profiler.reset();
    scorer.probabilities_of_all(random_stumps(4, 50, 20, random), Link::softmax, 1.0f, none.matrices());
    EXPECT_EQ(profiler.submissions(), 0u);
}

TEST(StumpParity, AGroupOverTheLimitIsASubmissionPerTile) {
    Random random(11);
    Group group({100, 156, 256, 1, 254}, 25, 3, random);  // 767 rows
    BoostedStumps classifier = random_stumps(3, 50, 25, random);
    for (std::uint32_t c = 0; c < 25; ++c) classifier.stumps[c].feature = c;  // all are uploaded
    for (const std::uint32_t bits : {8u, 16u, 32u}) {
        SCOPED_TRACE(bits);
        Profiler profiler;
        const auto scorer = scorer_of_bits(bits, 0, std::size_t{25} * bits / 8 * 256, &profiler);
        scorer->probabilities_of_all(classifier, Link::softmax, 1.0f, group.matrices());
        EXPECT_EQ(profiler.submissions(), 3u);
        expect_as_one_by_one(*scorer, classifier, group);
    }
}

// Of any number of bits features answer the same, so that sums are those of floats, bit for bit.
void expect_the_same_of_all_bits(const BoostedStumps& classifier, const FeatureMatrix& features) {
    std::vector<float> of_floats(features.rows * classifier.class_count);
    scorer_of_bits(32)->probabilities(classifier, features, Link::softmax, 1.0f, of_floats);
    for (const std::uint32_t bits : {8u, 16u, 32u})
        for (const std::uint32_t from_storage : {0u, 1u}) {
            SCOPED_TRACE(::testing::Message() << bits << " bits, from storage: " << from_storage);
            const auto scorer = scorer_of_bits(bits, from_storage);
            std::vector<float> actual(of_floats.size());
            scorer->probabilities(classifier, features, Link::softmax, 1.0f, actual);
            EXPECT_EQ(actual, of_floats);
            expect_stumps_parity(*scorer, classifier, features, Link::softmax, 1.0f);
        }
}

TEST(StumpPrecision, OddNumbersOfRows) {
    Random random(14);
    const BoostedStumps classifier = random_stumps(5, 100, 30, random);
    for (const std::size_t rows : {0u, 1u, 3u, 15u, 16u, 17u, 127u, 128u, 129u, 1003u}) {
        SCOPED_TRACE(rows);
        expect_the_same_of_all_bits(classifier, random_stump_features(rows, 30, random));
    }
}

TEST(StumpPrecision, ValuesAtThresholds) {
    constexpr float k_infinite = std::numeric_limits<float>::infinity(), k_largest = std::numeric_limits<float>::max();
    Random random(15);
    BoostedStumps classifier = random_stumps(4, 40, 3, random);
    classifier.stumps[0].threshold = std::nextafter(k_largest, 0.0f);
    classifier.stumps[1].threshold = -k_largest;
    classifier.stumps[2].threshold = -0.0f;
    FeatureMatrix features;
    std::vector<float> values{std::numeric_limits<float>::quiet_NaN(), k_infinite, -k_infinite, 0.0f, -0.0f};
    for (const Stump& stump : classifier.stumps)
        for (const float towards : {stump.threshold, k_infinite, -k_infinite})
            values.push_back(std::nextafter(stump.threshold, towards));
    // Numbers next to zero are zero to some devices.
    std::erase_if(values, [](float value) { return std::fpclassify(value) == FP_SUBNORMAL; });
    features.rows = values.size();
    for (const char* name : {"a", "b", "c"}) std::ranges::copy(values, features.add(name).begin());
    expect_the_same_of_all_bits(classifier, features);
}

// `count` thresholds of one feature. All sums are multiples of 1/64 below 2^11, which floats hold exactly.
BoostedStumps stumps_of_one_feature(std::uint32_t count, Random& random) {
    BoostedStumps classifier{.class_count = 2, .stumps = {}, .elsewhere = std::vector<float>(std::size_t{2} * count)};
    for (std::uint32_t i = 0; i < count; ++i) {
        const auto answer = static_cast<float>(random.index(3)) / 64 - 1.0f / 64;
        classifier.stumps.push_back({0, static_cast<float>(i), answer, 0, 1 + random.index(2)});
    }
    return classifier;
}

// Where ranks have not enough bits, more are taken; and several dispatches where a driver would leave loops early.
TEST(StumpPrecision, AnyNumberOfThresholds) {
    Random random(16);
    for (const std::uint32_t count : {1u, 126u, 127u, 128u, 129u, 32'767u, 32'768u, 65'535u, 65'536u, 200'000u}) {
        SCOPED_TRACE(count);
        FeatureMatrix features;
        features.rows = 37;
        for (float& value : features.add("test"))
            value = std::round(static_cast<float>(random.uniform(-1, count + 1.0)) * 2) / 2;
        features.values[0] = static_cast<float>(count);
        features.values[1] = static_cast<float>(count) - 1;
        const BoostedStumps classifier = stumps_of_one_feature(count, random);
        if (count <= test_support::shared_device().info().max_texels) {
            expect_the_same_of_all_bits(classifier, features);
        } else {  // a texel a stump: refused, naming the limit
            std::vector<float> out(features.rows * classifier.class_count);
            EXPECT_THROW(scorer_of_bits(32)->probabilities(classifier, features, Link::softmax, 1.0f, out),
                         DeviceLimitError);
        }
    }
}

TEST(StumpParity, NothingOfAGroupIsScoredIfOneIsRefused) {
    GpuStumpScorer gpu(test_support::shared_device());
    CpuStumpScorer cpu;
    Random random(12);
    const BoostedStumps classifier = random_stumps(3, 40, 5, random);
    for (StumpScorer* scorer : std::initializer_list<StumpScorer*>{&gpu, &cpu}) {
        Group group({10, 10}, 5, 3, random);
        group.features[1] = random_stump_features(10, 1, random);
        EXPECT_THROW(scorer->probabilities_of_all(classifier, Link::softmax, 1.0f, group.matrices()), ModelError);
        EXPECT_EQ(group.out[0], std::vector<float>(30, -1.0f));
    }
}

TEST(StumpParity, RefusesWhatTheReferenceRefuses) {
    GpuStumpScorer gpu(test_support::shared_device());
    CpuStumpScorer cpu;
    Random random(7);
    const FeatureMatrix features = random_stump_features(10, 5, random);
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
