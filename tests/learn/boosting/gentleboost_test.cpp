#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "host/learn/boosting/boosted_stumps.h"
#include "host/learn/boosting/jointboost.h"
#include "tests/learn/boosting/boosting_data.h"

namespace exemplar {
namespace {

/// GentleBoost on stumps as Friedman et al. write it: regression of z with the weights, w <- w exp(-z h).
TEST(GentleBoost, EqualsThePlainAlgorithm) {
    const Data data = make_data(150, 6, 2, 1.0, 19);
    BoostOptions options;
    options.rounds = 25;
    const BoostResult result = train_gentleboost(data.training(), options);
    std::vector<double> w(data.weights.begin(), data.weights.end());
    double total = 0.0;
    for (const double weight : w) total += weight;
    for (std::size_t m = 0; m < 25; ++m) {
        const Stump& stump = result.classifier.stumps[m];
        ASSERT_EQ(stump.classes, 2u);
        EXPECT_EQ(constants(result.classifier, m)[0], 0.0f);
        const auto fit = [&](std::uint32_t feature, float threshold, double* response) {
            double sw[2] = {}, sz[2] = {}, error = 0.0;
            for (std::size_t i = 0; i < 150; ++i) {
                const int side = data.features.column(feature)[i] > threshold;
                sw[side] += w[i];
                sz[side] += data.labels[i] == 1 ? w[i] : -w[i];
                error += w[i];
            }
            for (int side = 0; side < 2; ++side) {
                if (response) response[side] = sz[side] / sw[side];
                error -= sw[side] > 0.0 ? sz[side] * sz[side] / sw[side] : 0.0;
            }
            return error;
        };
        double least = 1e30, response[2];
        for (std::uint32_t f = 0; f < 6; ++f) {
            for (const float threshold : data.quantized.thresholds[f]) {
                least = std::min(least, fit(f, threshold, nullptr));
            }
        }
        EXPECT_NEAR(fit(stump.feature, stump.threshold, response), least, 1e-5 * least) << m;
        EXPECT_NEAR(stump.below, response[0], 1e-5);
        EXPECT_NEAR(stump.above, response[1], 1e-5);
        double loss = 0.0;
        for (std::size_t i = 0; i < 150; ++i) {
            const double h = response[data.features.column(stump.feature)[i] > stump.threshold];
            loss += w[i] *= std::exp(data.labels[i] == 1 ? -h : h);
        }
        EXPECT_NEAR(result.loss[m], loss / total, 1e-5);
    }
}

TEST(GentleBoost, ProbabilitiesAreTheSigmoidOfTwiceH) {
    const Data data = make_data(4000, 6, 2, 2.0, 20), held_out = make_data(4000, 6, 2, 2.0, 21);
    BoostOptions options;
    options.rounds = 20;
    const BoostResult result = train_gentleboost(data.training(), options);
    std::vector<float> p(4000 * 2);
    CpuStumpScorer().probabilities(result.classifier, held_out.features, Link::softmax, 2.0f, p);
    // Calibrated: among rows given a probability, about that share has label 1.
    double expected = 0.0, actual = 0.0, count = 0.0;
    for (std::size_t i = 0; i < 4000; ++i) {
        if (p[i * 2 + 1] < 0.6f || p[i * 2 + 1] > 0.9f) continue;
        expected += p[i * 2 + 1];
        actual += held_out.labels[i];
        count += 1.0;
    }
    ASSERT_GT(count, 100.0);
    EXPECT_NEAR(actual / count, expected / count, 0.08);
}

TEST(GentleBoost, OneClassAlone) {
    for (const std::int32_t only : {0, 1}) {
        Data data = make_data(50, 2, 2, 1.0, 22);
        std::fill(data.labels.begin(), data.labels.end(), only);
        BoostOptions options;
        options.rounds = 20;
        const BoostResult result = train_gentleboost(data.training(), options);
        EXPECT_EQ(training_accuracy(result.classifier, data), 1.0) << only;
        EXPECT_TRUE(std::isfinite(result.loss.back()));
    }
}

}  // namespace
}  // namespace exemplar
