#include "host/learn/boosting/calibration.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "host/core/random.h"

namespace exemplar {
namespace {

constexpr std::array<Link, 2> k_links{Link::softmax, Link::sigmoid};
constexpr std::span<const Link> k_softmax = std::span(k_links).first(1);
constexpr std::size_t k_calibrated_classes = 3;

struct Scores {
    std::vector<float> h;
    std::vector<std::int32_t> labels;
    std::vector<float> weights;
};

/// Rows whose labels are drawn from the softmax of `scale` times their scores.
Scores drawn_from_softmax(std::size_t rows, double scale) {
    Random random(3);
    Scores set;
    for (std::size_t i = 0; i < rows; ++i) {
        std::array<double, k_calibrated_classes> weight{};
        double total = 0;
        for (double& w : weight) {
            const double h = 6 * random.uniform() - 3;
            set.h.push_back(static_cast<float>(h));
            total += w = std::exp(scale * h);
        }
        double at = random.uniform() * total;
        std::int32_t label = 0;
        while (label < 2 && at > weight[label]) at -= weight[label++];
        set.labels.push_back(label);
        set.weights.push_back(1);
    }
    return set;
}

TEST(Calibration, FindsTheScaleThatTheLabelsWereDrawnWith) {
    for (const double scale : {0.1, 0.5, 2.0}) {
        const Scores set = drawn_from_softmax(20000, scale);
        const Calibration found = calibrate(set.h, set.labels, set.weights, k_calibrated_classes, k_softmax);
        EXPECT_NEAR(found.scale / scale, 1, 0.1);
        EXPECT_EQ(found.link, Link::softmax);
    }
}

TEST(Calibration, ReportsTheWeightedErrorAndLossByHand) {
    // Equal scores: P = 1/2 whatever the scale; the first class wins ties.
    const std::vector<float> h{0, 0, 0, 0}, weights{3, 1};
    const std::vector<std::int32_t> labels{0, 1};
    const Calibration found = calibrate(h, labels, weights, 2, k_softmax);
    EXPECT_NEAR(found.loss, std::log(2.0), 1e-6);
    EXPECT_NEAR(found.error, 0.25, 1e-9);
}

TEST(Calibration, RowsOfWeightZeroDoNotCount) {
    Scores set = drawn_from_softmax(5000, 1);
    const Calibration before = calibrate(set.h, set.labels, set.weights, k_calibrated_classes, k_links);
    for (int i = 0; i < 500; ++i) {
        set.h.insert(set.h.end(), {100, -100, -100});
        set.labels.push_back(2);
        set.weights.push_back(0);
    }
    const Calibration after = calibrate(set.h, set.labels, set.weights, k_calibrated_classes, k_links);
    EXPECT_EQ(before.scale, after.scale);
    EXPECT_NEAR(before.loss, after.loss, 1e-9);
    EXPECT_NEAR(before.error, after.error, 1e-12);
}

TEST(Calibration, AFewConfidentMistakesDoNotFlattenTheRest) {
    Scores set = drawn_from_softmax(5000, 1);
    for (int i = 0; i < 50; ++i) {  // one percent: a class that was never seen
        set.h.insert(set.h.end(), {0, 0, -300});
        set.labels.push_back(2);
        set.weights.push_back(1);
    }
    EXPECT_NEAR(calibrate(set.h, set.labels, set.weights, k_calibrated_classes, k_softmax).scale, 1, 0.1);
}

TEST(Calibration, TakesTheBetterLink) {
    Scores set = drawn_from_softmax(5000, 1);
    const Calibration both = calibrate(set.h, set.labels, set.weights, k_calibrated_classes, k_links);
    for (const Link& link : k_links)
        EXPECT_LE(both.loss, calibrate(set.h, set.labels, set.weights, k_calibrated_classes, std::span(&link, 1)).loss);
}

TEST(Calibration, ExtremeScoresStayFinite) {
    const std::vector<float> h{-300, -300, 300, -300}, weights{1, 1};
    const std::vector<std::int32_t> labels{0, 1};
    for (const Link& link : k_links)
        EXPECT_TRUE(std::isfinite(calibrate(h, labels, weights, 2, std::span(&link, 1)).loss));
}

TEST(Calibration, NothingToJudgeIsNotANumber) {
    EXPECT_TRUE(std::isnan(calibrate({}, {}, {}, 2, k_links).loss));
    const std::vector<float> h{0, 0}, weights{0};
    const std::vector<std::int32_t> labels{1};
    EXPECT_TRUE(std::isnan(calibrate(h, labels, weights, 2, k_links).error));
}

}  // namespace
}  // namespace exemplar
