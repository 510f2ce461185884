#include "host/learn/regression/linear_classifier.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "host/core/errors.h"
#include "host/core/parallel.h"
#include "host/core/random.h"

namespace exemplar {
namespace {

constexpr std::size_t k_rows = 900, k_inputs = 7, k_classes = 3, k_folds = 3;

/// Rows of random features, each labeled by which of three sums of features is largest.
struct ClassifierData {
    FeatureMatrix features;
    std::vector<std::uint32_t> rows;
    std::vector<std::int32_t> label;
    std::vector<float> weight;
    std::vector<std::uint8_t> fold;

    explicit ClassifierData(std::size_t count = k_rows) : rows(count) {
        Random random(5);
        features.rows = count;
        for (std::size_t f = 0; f < k_inputs; ++f)
            for (float& value : features.add("a." + std::to_string(f)))
                value = static_cast<float>(random.uniform(-1.0, 1.0)) * (f == 2 ? 1000.0F : 1.0F) + 3;
        std::iota(rows.begin(), rows.end(), 0U);
        for (std::size_t i = 0; i < count; ++i) {
            const auto x = [&](std::size_t f) { return features.column(f)[i] - 3; };
            const std::array<float, k_classes> sum{x(0) + x(1), x(2) / 1000, x(3) - x(4)};
            label.push_back(static_cast<std::int32_t>(std::max_element(sum.begin(), sum.end()) - sum.begin()));
            weight.push_back(static_cast<float>(random.uniform(0.5, 1.5)));
            fold.push_back(static_cast<std::uint8_t>(random.index(k_folds)));
        }
    }
    LinearRows all() const { return {features, rows, label, weight, fold, k_classes, k_folds}; }
};

std::vector<float> scores_of(const LinearClassifier& classifier, const FeatureMatrix& features) {
    std::vector<float> scores(features.rows * k_classes);
    linear_scores(classifier, features, scores);
    return scores;
}

double share_right(const ClassifierData& data, const std::vector<float>& scores) {
    double right = 0;
    for (std::size_t i = 0; i < data.label.size(); ++i) {
        const auto row = scores.begin() + static_cast<std::ptrdiff_t>(i * k_classes);
        right += std::max_element(row, row + k_classes) - row == data.label[i];
    }
    return right / static_cast<double>(data.label.size());
}

/// The textbook's ridge regression of one class, of the rows outside of a fold: constant, then weights of z.
Eigen::VectorXd by_hand(const ClassifierData& data, const LinearClassifier& standard, double ridge,
                        std::size_t without_fold, int label) {
    std::vector<std::size_t> rows;
    for (std::size_t i = 0; i < k_rows; ++i)
        if (data.fold[i] != without_fold) rows.push_back(i);
    Eigen::MatrixXd x(rows.size(), k_inputs + 1);
    Eigen::VectorXd y(rows.size()), w(rows.size());
    for (std::size_t r = 0; r < rows.size(); ++r) {
        x(r, 0) = 1;
        for (std::size_t f = 0; f < k_inputs; ++f)
            x(r, f + 1) =
                std::clamp((data.features.column(f)[rows[r]] - standard.mean[f]) * standard.inverse[f], -5.0F, 5.0F);
        y[r] = data.label[rows[r]] == label;
        w[r] = data.weight[rows[r]];
    }
    Eigen::MatrixXd normal = x.transpose() * w.asDiagonal() * x;
    for (std::size_t f = 1; f <= k_inputs; ++f) normal(f, f) += ridge * w.sum();
    return normal.ldlt().solve(x.transpose() * w.asDiagonal() * y);
}

TEST(LinearClassifier, SolvesTheEquationsOfARidge) {
    const ClassifierData data;
    const LinearTraining training(data.all());
    for (const double ridge : {1e-6, 1e-2, 1.0})
        for (const std::size_t fold : {LinearTraining::k_no_fold, std::size_t{1}}) {
            const LinearClassifier found = training.solve(ridge, fold);
            for (int c = 0; c < static_cast<int>(k_classes); ++c) {
                const Eigen::VectorXd expected = by_hand(data, found, ridge, fold, c);
                EXPECT_NEAR(found.constant[c], expected[0], 1e-5);
                for (std::size_t f = 0; f < k_inputs; ++f)
                    EXPECT_NEAR(found.weight[f * k_classes + c], expected[f + 1], 1e-5);
            }
        }
}

TEST(LinearClassifier, TellsLabelsApartThatSumsOfFeaturesTell) {
    const ClassifierData data;
    const LinearTraining training(data.all());
    EXPECT_GT(share_right(data, scores_of(training.solve(1e-4), data.features)), 0.93);
}

TEST(LinearClassifier, TargetsAddUpToOneInEveryRow) {
    const ClassifierData data;
    const std::vector<float> scores = scores_of(LinearTraining(data.all()).solve(1e-3), data.features);
    for (std::size_t i = 0; i < k_rows; ++i)
        EXPECT_NEAR(scores[3 * i] + scores[3 * i + 1] + scores[3 * i + 2], 1, 1e-4);
}

TEST(LinearClassifier, UnitsMakeNoDifference) {
    ClassifierData data;
    const std::vector<float> before = scores_of(LinearTraining(data.all()).solve(1e-2), data.features);
    for (float& value : data.features.column(0)) value = 1024 * value - 7;
    const std::vector<float> after = scores_of(LinearTraining(data.all()).solve(1e-2), data.features);
    for (std::size_t i = 0; i < before.size(); ++i) EXPECT_NEAR(before[i], after[i], 1e-4);
}

TEST(LinearClassifier, RowsAreWeighed) {
    // Rows of weight zero may be anything; a row of weight two is two rows.
    ClassifierData data, twice;
    for (std::size_t i = 0; i < k_rows; ++i) data.weight[i] = static_cast<float>(i % 3);
    twice.rows.clear();
    for (std::uint32_t i = 0; i < k_rows; ++i) {
        twice.weight[i] = 1;
        for (std::uint32_t k = 0; k < i % 3; ++k) twice.rows.push_back(i);
    }
    const std::vector<float> weighed = scores_of(LinearTraining(data.all()).solve(1e-3), data.features);
    const std::vector<float> repeated = scores_of(LinearTraining(twice.all()).solve(1e-3), data.features);
    for (std::size_t i = 0; i < weighed.size(); ++i) EXPECT_NEAR(weighed[i], repeated[i], 1e-4);
}

TEST(LinearClassifier, FeaturesThatDoNotVaryOrAreNoNumbersCountForNothing) {
    ClassifierData data;
    const std::vector<float> before = scores_of(LinearTraining(data.all()).solve(1e-3), data.features);
    for (float& value : data.features.add("a.same")) value = 1e6F;
    data.features.add("a.odd")[17] = std::numeric_limits<float>::quiet_NaN();
    const LinearClassifier found = LinearTraining(data.all()).solve(1e-3);
    EXPECT_EQ(found.inverse[k_inputs], 0);
    EXPECT_EQ(found.inverse[k_inputs + 1], 0);
    const std::vector<float> after = scores_of(found, data.features);
    for (std::size_t i = 0; i < before.size(); ++i) EXPECT_NEAR(before[i], after[i], 1e-6);
}

TEST(LinearClassifier, WhatIsStrangeStaysWithinBounds) {
    ClassifierData data;
    const LinearClassifier found = LinearTraining(data.all()).solve(1e-3);
    constexpr float k_unbounded = std::numeric_limits<float>::infinity();
    data.features.column(0)[0] = k_unbounded;
    data.features.column(0)[1] = 1e30F;
    data.features.column(0)[2] = std::numeric_limits<float>::quiet_NaN();
    data.features.column(0)[3] = found.mean[0];
    for (std::size_t f = 1; f < k_inputs; ++f)
        for (std::size_t i = 1; i < 4; ++i) data.features.column(f)[i] = data.features.column(f)[0];
    const std::vector<float> scores = scores_of(found, data.features);
    for (std::size_t c = 0; c < k_classes; ++c) {
        EXPECT_TRUE(std::isfinite(scores[c]));
        EXPECT_EQ(scores[c], scores[k_classes + c]);                      // as far out as one goes
        EXPECT_EQ(scores[2 * k_classes + c], scores[3 * k_classes + c]);  // as the mean
    }
}

TEST(LinearClassifier, ChosenRowsScoreAsAmongAll) {
    const ClassifierData data;
    const LinearClassifier found = LinearTraining(data.all()).solve(1e-3);
    const std::vector<float> all = scores_of(found, data.features);
    const std::vector<std::uint32_t> rows{899, 0, 300, 300};
    std::vector<float> some(rows.size() * k_classes);
    linear_scores(found, data.features, rows, some);
    for (std::size_t i = 0; i < rows.size(); ++i)
        for (std::size_t c = 0; c < k_classes; ++c)
            EXPECT_FLOAT_EQ(some[i * k_classes + c], all[rows[i] * k_classes + c]);
}

TEST(LinearClassifier, ThreadsMakeNoDifference) {
    const ClassifierData data(5000);
    const auto learn = [&](std::size_t threads) {
        const ThreadLimit limit(threads);
        return scores_of(LinearTraining(data.all()).solve(1e-3), data.features);
    };
    EXPECT_EQ(learn(1), learn(2));
}

TEST(LinearClassifier, TheMeanScoresTheMean) {
    const ClassifierData data;
    const LinearTraining training(data.all());
    const std::vector<LinearClassifier> two{training.solve(1e-3, 0), training.solve(1e-3, 1)};
    const std::vector<float> first = scores_of(two[0], data.features), second = scores_of(two[1], data.features);
    const std::vector<float> mean = scores_of(mean_linear(two), data.features);
    for (std::size_t i = 0; i < mean.size(); ++i) EXPECT_NEAR(mean[i], (first[i] + second[i]) / 2, 1e-5);
}

TEST(LinearClassifier, WhatDoesNotFitIsRefused) {
    ClassifierData data;
    const LinearClassifier found = LinearTraining(data.all()).solve(1e-3);
    std::vector<float> scores(5);
    EXPECT_THROW(linear_scores(found, data.features, scores), UsageError);
    FeatureMatrix few;
    few.rows = 1;
    few.add("a.0");
    EXPECT_THROW(linear_scores(found, few, std::span(scores).first(3)), ModelError);
    data.weight.assign(k_rows, 0.0F);
    EXPECT_THROW(LinearTraining(data.all()), UsageError);
    data.weight.pop_back();
    EXPECT_THROW(LinearTraining(data.all()), UsageError);
}

}  // namespace
}  // namespace exemplar
