#include "host/hatching/style/property_model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "host/core/errors.h"
#include "host/core/parallel.h"
#include "host/core/random.h"
#include "host/hatching/features/powers.h"

namespace exemplar {
namespace {

/// Eight features that know nothing of each other: 0 and 1 in [0, 1], 2 in [0.5, 3], 3 in [-1, 1], the rest normal.
FeatureMatrix random_features(std::size_t rows, std::uint64_t seed) {
    Random random(seed);
    FeatureMatrix features;
    features.rows = rows;
    for (std::size_t k = 0; k < 8; ++k)
        for (float& x : features.add(std::string("x").append(std::to_string(k)))) {
            const double u = random.uniform();
            x = static_cast<float>(k < 2 ? u : k == 2 ? 0.5 + 2.5 * u : k == 3 ? 2 * u - 1 : random.normal());
        }
    return features;
}

using Truth = std::function<double(const FeatureMatrix&, std::size_t)>;

double value(const FeatureMatrix& features, std::size_t column, std::size_t row) {
    return static_cast<double>(features.column(column)[row]);
}

/// Four blocks.
std::vector<std::uint8_t> blocks(std::size_t rows) {
    std::vector<std::uint8_t> block;
    for (std::size_t i = 0; i < rows; ++i) block.push_back(static_cast<std::uint8_t>(4 * i / rows));
    return block;
}

/// Of 4000 rows, every fourth held out, with relative noise.
LearnedProperty learned(const Truth& truth, double noise = 0) {
    const FeatureMatrix features = random_features(4000, 1);
    Random random(2);
    std::vector<float> target;
    std::vector<std::uint8_t> held_out;
    for (std::size_t i = 0; i < features.rows; ++i) {
        target.push_back(static_cast<float>(truth(features, i) * std::exp(noise * random.normal())));
        held_out.push_back(i % 4 == 0);
    }
    return learn_property({features, quantize(features, {}, {}), target, held_out, blocks(features.rows)});
}

float evaluate(const PropertyModel& model, const FeatureMatrix& features, std::size_t row) {
    return model.evaluate([&](std::uint32_t k) { return power_of(features.column(k / k_powers)[row], k % k_powers); });
}

/// Root mean square of the relative error on rows that were not seen.
double unseen_error(const PropertyModel& model, const Truth& truth) {
    const FeatureMatrix features = random_features(1000, 99);
    double sum = 0;
    for (std::size_t i = 0; i < features.rows; ++i) {
        const double error = static_cast<double>(evaluate(model, features, i)) / truth(features, i) - 1;
        sum += error * error / 1000;
    }
    return std::sqrt(sum);
}

bool uses_only(const PropertyModel& model, std::initializer_list<std::size_t> features) {
    return std::ranges::all_of(model.terms, [&](const PropertyModel::Term& term) {
        return std::ranges::find(features, term.feature / k_powers) != features.end();
    });
}

TEST(PropertyModel, RecoversAProductOfTwoFeatures) {
    for (const double exponent : {1.0, -0.7, 0.5}) {
        SCOPED_TRACE(exponent);
        const Truth truth = [&](const FeatureMatrix& f, std::size_t i) {
            return 3 * (2 * value(f, 0, i) + 0.5) * std::pow(1.5 * value(f, 2, i) + 1, exponent);
        };
        const LearnedProperty exact = learned(truth);
        EXPECT_LT(unseen_error(exact.model, truth), 0.02);
        EXPECT_TRUE(uses_only(exact.model, {0, 2}));
        EXPECT_LT(exact.error, 4e-4);
    }
}

TEST(PropertyModel, NoiseIsAveragedAndNotLearned) {
    const Truth truth = [](const FeatureMatrix& f, std::size_t i) { return 3 * (2 * value(f, 0, i) + 0.5); };
    const LearnedProperty noisy = learned(truth, 0.2);
    EXPECT_LT(unseen_error(noisy.model, truth), 0.02);
    EXPECT_TRUE(uses_only(noisy.model, {0}));
    EXPECT_NEAR(noisy.error, 0.04, 0.006);
}

TEST(PropertyModel, FindsInversesAndSquares) {
    const Truth inverse = [](const FeatureMatrix& f, std::size_t i) { return 0.2 + 1 / value(f, 2, i); };
    EXPECT_LT(unseen_error(learned(inverse).model, inverse), 0.02);
    const Truth square = [](const FeatureMatrix& f, std::size_t i) { return 0.1 + value(f, 3, i) * value(f, 3, i); };
    const LearnedProperty found = learned(square);
    EXPECT_LT(unseen_error(found.model, square), 0.03);
    EXPECT_TRUE(uses_only(found.model, {3}));
}

// One that fits everywhere but in a quarter, and one that is a little worse, but everywhere.
TEST(PropertyModel, PrefersWhatHoldsEverywhere) {
    Random random(7);
    FeatureMatrix features;
    features.rows = 4000;
    const std::vector<std::uint8_t> block = blocks(features.rows);
    std::vector<float> target;
    std::vector<std::uint8_t> held_out;
    for (const char* name : {"by chance", "true"}) features.add(name);
    for (std::size_t i = 0; i < features.rows; ++i) {
        const auto truth = static_cast<float>(1 + random.uniform());
        target.push_back(truth);
        features.column(1)[i] = truth * static_cast<float>(std::exp(0.05 * random.normal()));
        features.column(0)[i] = block[i] == 3 ? static_cast<float>(1.5 + 0.01 * random.uniform()) : truth;
        held_out.push_back(block[i] != 3 && i % 4 == 0);
    }
    const LearnedProperty found = learn_property({features, quantize(features, {}, {}), target, held_out, block, 1});
    EXPECT_TRUE(uses_only(found.model, {1}));
}

TEST(PropertyModel, AConstantNeedsNoFeatures) {
    const LearnedProperty constant = learned([](const FeatureMatrix&, std::size_t) { return 2.5; });
    EXPECT_TRUE(constant.model.terms.empty());
    EXPECT_NEAR(constant.model.factor, 2.5f, 1e-5f);
    EXPECT_NEAR(constant.error, 0, 1e-9);
}

// What no feature tells is left to its mean (of the logarithm: 0).
TEST(PropertyModel, NoiseAloneHasNearlyNoModel) {
    const Truth one = [](const FeatureMatrix&, std::size_t) { return 1.0; };
    EXPECT_LT(unseen_error(learned(one, 0.3).model, one), 0.03);
}

TEST(PropertyModel, BeyondTheRangeOfTrainingCountsItsEnd) {
    const Truth truth = [](const FeatureMatrix& f, std::size_t i) { return 1 + 4 * value(f, 0, i); };
    const PropertyModel model = learned(truth).model;
    const auto at = [&](float x) {
        return model.evaluate([&](std::uint32_t k) { return power_of(k / k_powers == 0 ? x : 0.5f, k % k_powers); });
    };
    EXPECT_NEAR(at(0.5f), 3, 0.05);
    EXPECT_NEAR(at(100.0f), at(1.0f), 0.01f);
    EXPECT_NEAR(at(1.0f), 5, 0.1);
    EXPECT_NEAR(at(-100.0f), at(0.0f), 0.01f);
    EXPECT_NEAR(at(0.0f), 1, 0.05);
}

TEST(PropertyModel, ATermIsItsDefinition) {
    const PropertyModel::Term term{
        .feature = 0, .a = 2, .b = 1, .exponent = -0.5f, .low = -0.4f, .high = 4, .least = 0.25f};
    const auto value_at = [&](float x) { return std::exp(PropertyModel::log_value(term, x)); };
    EXPECT_NEAR(value_at(1.5f), 0.5f, 1e-6f);
    EXPECT_NEAR(value_at(4), 1 / 3.0f, 1e-6f);
    EXPECT_EQ(value_at(5), value_at(4));
    EXPECT_EQ(value_at(std::numeric_limits<float>::infinity()), value_at(4));
    // 2 x + 1 is 0.2 at the low end, which is less than there may be.
    EXPECT_NEAR(value_at(-0.4f), 2, 1e-6f);
    EXPECT_EQ(value_at(-9), value_at(-0.4f));
    EXPECT_EQ(value_at(std::numeric_limits<float>::quiet_NaN()), value_at(-0.4f));
}

TEST(PropertyModel, PowersAvoidInfinity) {
    EXPECT_EQ(power_of(-3, 0), -3);
    EXPECT_EQ(power_of(-3, 1), 9);
    EXPECT_EQ(power_of(-4, 2), -0.25f);
    EXPECT_EQ(power_of(-4, 3), 0.0625f);
    EXPECT_FLOAT_EQ(power_of(0, 2), 1e6f);
    EXPECT_FLOAT_EQ(power_of(-1e-9f, 2), -1e6f);
    EXPECT_FLOAT_EQ(power_of(-1e-9f, 3), 1e12f);
    EXPECT_EQ(name_of_power("x", 0), "x");
    EXPECT_EQ(name_of_power("x", 3), "1/x^2");
}

TEST(PropertyModel, IsDeterministic) {
    const Truth truth = [](const FeatureMatrix& f, std::size_t i) { return 1 + value(f, 0, i) + value(f, 1, i); };
    const LearnedProperty first = learned(truth, 0.1);
    const ThreadLimit one(1);
    EXPECT_EQ(learned(truth, 0.1).model, first.model);
}

TEST(PropertyModel, BadInputIsRefused) {
    const FeatureMatrix features = random_features(50, 1), none = random_features(0, 1);
    const QuantizedFeatures quantized = quantize(features, {}, {}), no_quantized = quantize(none, {}, {});
    const std::vector<std::uint8_t> held(50), few(49), block(50), fifth(50, 4);
    const std::vector<float> good(50, 1.0f), missing(49, 1.0f);
    EXPECT_NO_THROW(learn_property({features, quantized, good, held, block}));
    EXPECT_THROW(learn_property({features, quantized, missing, held, block}), UsageError);
    EXPECT_THROW(learn_property({features, quantized, good, few, block}), UsageError);
    EXPECT_THROW(learn_property({features, quantized, good, held, few}), UsageError);
    EXPECT_THROW(learn_property({features, quantized, good, held, fifth}), UsageError);
    EXPECT_THROW(learn_property({features, no_quantized, good, held, block}), UsageError);
    EXPECT_THROW(learn_property({none, no_quantized, {}, {}, {}}), UsageError);
    for (const float bad :
         {0.0f, -1.0f, std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN()}) {
        std::vector<float> target = good;
        target[17] = bad;
        EXPECT_THROW(learn_property({features, quantized, target, held, block}), DataError) << bad;
    }
}

}  // namespace
}  // namespace exemplar
