#include "host/learn/boosting/boosted_stumps.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "host/core/errors.h"
#include "host/core/parallel.h"
#include "host/core/random.h"

namespace exemplar {
namespace {

FeatureMatrix random_features(std::size_t rows, std::size_t cols, Random& random) {
    FeatureMatrix matrix;
    matrix.rows = rows;
    for (std::size_t f = 0; f < cols; ++f) {
        for (float& value : matrix.add(fmt::format("f{}", f))) {
            value = random.uniform() < 0.05 ? std::nanf("") : static_cast<float>(random.normal());
        }
    }
    return matrix;
}

BoostedStumps random_classifier(std::size_t classes, std::size_t stumps, std::size_t cols, Random& random) {
    BoostedStumps out;
    out.class_count = static_cast<std::uint32_t>(classes);
    for (std::size_t m = 0; m < stumps; ++m) {
        const std::uint64_t all = classes == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << classes) - 1;
        const std::uint64_t shared = random.next() & all;
        const auto draw = [&] { return static_cast<float>(random.uniform(-1.0, 1.0)); };
        const auto feature = static_cast<std::uint32_t>(random.index(cols));
        const float threshold = draw(), above = draw(), below = draw();
        out.stumps.push_back({feature, threshold, above, below, shared});
        for (std::size_t c = 0; c < classes; ++c) out.elsewhere.push_back(shared >> c & 1 ? 0.0f : draw());
    }
    return out;
}

/// Eqs. 2.64 to 2.66 written out.
std::vector<double> plain_probabilities(const BoostedStumps& classifier, const FeatureMatrix& features, std::size_t row,
                                        Link link, double scale) {
    std::vector<double> p(classifier.class_count, 0.0);
    for (std::size_t c = 0; c < p.size(); ++c) {
        for (std::size_t m = 0; m < classifier.stumps.size(); ++m) {
            const Stump& stump = classifier.stumps[m];
            const bool above = features.column(stump.feature)[row] > stump.threshold;
            p[c] += !(stump.classes >> c & 1) ? classifier.elsewhere[m * p.size() + c]
                    : above                   ? stump.above
                                              : stump.below;
        }
        p[c] = link == Link::softmax ? std::exp(scale * p[c]) : 1.0 / (1.0 + std::exp(-scale * p[c]));
    }
    double sum = 0.0;
    for (const double value : p) sum += value;
    for (double& value : p) value /= sum;
    return p;
}

TEST(BoostedStumps, ProbabilitiesFollowTheEquations) {
    Random random(1);
    for (const std::size_t classes : {1u, 2u, 5u, 8u, 13u, 64u}) {
        for (const std::size_t rows : {0u, 1u, 255u, 256u, 257u, 700u}) {
            const FeatureMatrix features = random_features(rows, 4, random);
            const BoostedStumps classifier = random_classifier(classes, 20, 4, random);
            for (const Link link : {Link::softmax, Link::sigmoid}) {
                std::vector<float> out(rows * classes, -1.0f);
                CpuStumpScorer().probabilities(classifier, features, link, 1.5f, out);
                for (std::size_t i = 0; i < rows; i += 37) {
                    const std::vector<double> expected = plain_probabilities(classifier, features, i, link, 1.5);
                    for (std::size_t c = 0; c < classes; ++c) {
                        ASSERT_NEAR(out[i * classes + c], expected[c], 1e-5) << classes << " " << rows;
                    }
                }
            }
        }
    }
}

TEST(BoostedStumps, StayFiniteFarOut) {
    FeatureMatrix features;
    features.rows = 1;
    features.add("f")[0] = 1.0f;
    const BoostedStumps classifier{2, {{0, 0.0f, -500.0f, 0.0f, 1}}, {0.0f, -400.0f}};
    for (const Link link : {Link::softmax, Link::sigmoid}) {
        std::vector<float> out(2);
        CpuStumpScorer().probabilities(classifier, features, link, 1.0f, out);
        EXPECT_FLOAT_EQ(out[1], 1.0f);
        EXPECT_GE(out[0], 0.0f);
        EXPECT_LT(out[0], 1e-6f);
    }
}

TEST(BoostedStumps, NanIsNotAbove) {
    FeatureMatrix features;
    features.rows = 3;
    const std::span<float> column = features.add("f");
    column[0] = std::nanf("");
    column[1] = 0.0f;  // equal to the threshold: not above
    column[2] = 0.5f;
    const BoostedStumps classifier{2, {{0, 0.0f, 3.0f, -3.0f, 1}}, {0.0f, 0.0f}};
    std::vector<float> out(6);
    CpuStumpScorer().probabilities(classifier, features, Link::softmax, 1.0f, out);
    EXPECT_EQ(out[0], out[2]);
    EXPECT_LT(out[0], 0.1f);
    EXPECT_GT(out[4], 0.9f);
}

TEST(BoostedStumps, WithoutStumpsAllClassesAreEqual) {
    FeatureMatrix features;
    features.rows = 2;
    std::vector<float> out(6);
    CpuStumpScorer().probabilities({3, {}, {}}, features, Link::sigmoid, 1.0f, out);
    for (const float p : out) EXPECT_FLOAT_EQ(p, 1.0f / 3.0f);
}

TEST(BoostedStumps, SumConstantsPerClass) {
    const BoostedStumps classifier{2, {{0, 0, 1, 1, 1}, {0, 0, 1, 1, 0}}, {0.0f, -1.0f, 0.25f, -1.5f}};
    EXPECT_EQ(classifier.constant(), (std::vector<float>{0.25f, -2.5f}));
}

TEST(BoostedStumps, DoNotDependOnThreads) {
    Random random(2);
    const FeatureMatrix features = random_features(3000, 3, random);
    const BoostedStumps classifier = random_classifier(6, 30, 3, random);
    std::vector<float> many(3000 * 6), one(3000 * 6);
    CpuStumpScorer().probabilities(classifier, features, Link::softmax, 1.0f, many);
    const ThreadLimit limit(1);
    CpuStumpScorer().probabilities(classifier, features, Link::softmax, 1.0f, one);
    EXPECT_EQ(many, one);
}

TEST(BoostedStumps, RefuseWhatDoesNotFit) {
    FeatureMatrix features;
    features.rows = 1;
    features.add("f");
    std::vector<float> out(2);
    CpuStumpScorer scorer;
    const BoostedStumps good{2, {{0, 0, 1, 1, 1}}, {0, 0}};
    EXPECT_NO_THROW(scorer.probabilities(good, features, Link::softmax, 1.0f, out));
    BoostedStumps bad = good;
    bad.stumps[0].feature = 1;
    EXPECT_THROW(scorer.probabilities(bad, features, Link::softmax, 1.0f, out), ModelError);
    bad = good;
    bad.stumps[0].classes = 4;
    EXPECT_THROW(scorer.probabilities(bad, features, Link::softmax, 1.0f, out), ModelError);
    bad = good;
    bad.elsewhere.pop_back();
    EXPECT_THROW(scorer.probabilities(bad, features, Link::softmax, 1.0f, out), ModelError);
    bad = good;
    bad.class_count = 65;
    EXPECT_THROW(scorer.probabilities(bad, features, Link::softmax, 1.0f, out), ModelError);
    EXPECT_THROW(scorer.probabilities(good, features, Link::softmax, 0.0f, out), UsageError);
    EXPECT_THROW(scorer.probabilities(good, features, Link::softmax, 1.0f, std::span(out).first(1)), UsageError);
}

TEST(MeanClassifier, HasTheMeanOfTheScores) {
    BoostedStumps first{2, {{0, 0.5F, 2.0F, -1.0F, 0b01}}, {0.0F, 0.25F}};
    BoostedStumps second{2, {{0, 1.5F, 1.0F, 0.5F, 0b11}, {0, 0.5F, 4.0F, 0.0F, 0b10}}, {0.0F, 0.0F, -1.0F, 0.0F}};
    const BoostedStumps mean = mean_classifier(std::vector{first, second});
    FeatureMatrix features;
    features.rows = 3;
    std::ranges::copy(std::array{0.0F, 1.0F, 2.0F}, features.add("x").begin());
    CpuStumpScorer scorer;
    const auto log_odds = [&](const BoostedStumps& classifier) {
        std::vector<float> p(6), odds;
        scorer.probabilities(classifier, features, Link::softmax, 1.0F, p);
        for (std::size_t i = 0; i < 3; ++i) odds.push_back(std::log(p[2 * i] / p[2 * i + 1]));
        return odds;
    };
    const std::vector<float> a = log_odds(first), b = log_odds(second), of_mean = log_odds(mean);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(of_mean[i], 0.5F * (a[i] + b[i]), 1e-5F);
}

}  // namespace
}  // namespace exemplar
