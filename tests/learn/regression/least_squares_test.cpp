#include "host/learn/regression/least_squares.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <vector>

#include "host/core/errors.h"
#include "host/core/parallel.h"
#include "tests/learn/regression/normal_matrix.h"

namespace exemplar {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// A column of ones and `count` - 1 normal ones of very different scales and means.
MatrixXd some_features(Index samples, Index count, std::uint64_t seed) {
    MatrixXd features = normal_matrix(samples, count, seed);
    for (Index p = 1; p < count; ++p) {
        features.col(p) = features.col(p) * std::pow(10.0, static_cast<double>(p % 5) - 2) +
                          VectorXd::Constant(samples, static_cast<double>(p));
    }
    features.col(0).setOnes();
    return features;
}

/// Penalty per feature: ridge times the variance, none for the constant.
VectorXd penalties(const MatrixXd& features, double ridge) {
    VectorXd out = ridge * (features.rowwise() - features.colwise().mean()).array().square().colwise().mean().matrix();
    out(0) = 0;
    return out;
}

MatrixXd by_normal_equations(const MatrixXd& features, const MatrixXd& targets, const VectorXd& penalty) {
    const MatrixXd normal = features.transpose() * features + MatrixXd(penalty.asDiagonal());
    return normal.fullPivLu().solve(features.transpose() * targets);
}

TEST(PolynomialFeatures, AreInTheOrderOfTheThesis) {
    const Eigen::RowVector2f row(2, -3);
    EXPECT_EQ(polynomial_features(row, 3), (Eigen::RowVectorXd(7) << 1, 2, -3, 4, 9, 8, -27).finished());
    EXPECT_EQ(polynomial_features(row, 2), (Eigen::RowVectorXd(5) << 1, 2, -3, 4, 9).finished());
    EXPECT_EQ(polynomial_features(row, 1).cols(), 3);
    EXPECT_EQ(polynomial_features(Eigen::MatrixXf(4, 0), 2), MatrixXd::Ones(4, 1));
}

TEST(PolynomialFeatures, RefuseOtherDegrees) {
    EXPECT_THROW(polynomial_features(Eigen::MatrixXf(1, 3), 0), UsageError);
    EXPECT_THROW(polynomial_features(Eigen::MatrixXf(1, 3), 4), UsageError);
}

TEST(LeastSquares, RecoverAPolynomialExactly) {
    const Eigen::MatrixXf x = normal_matrix(60, 4, 1).cast<float>();
    const MatrixXd features = polynomial_features(x, 3), truth = normal_matrix(13, 5, 2);
    EXPECT_LT((LeastSquares(features).solve(features * truth) - truth).norm(), 1e-10 * truth.norm());
}

TEST(LeastSquares, SolveThePenalizedNormalEquations) {
    const MatrixXd features = some_features(80, 9, 3), targets = normal_matrix(80, 700, 4).array() + 7;
    for (const double ridge : {0.0, 0.3, 80.0, 1e5}) {
        const MatrixXd expected = by_normal_equations(features, targets, penalties(features, ridge));
        EXPECT_LT((LeastSquares(features, ridge).solve(targets) - expected).norm(), 1e-8 * expected.norm()) << ridge;
    }
}

TEST(LeastSquares, DoNotDependOnTheUnitsOfFeatures) {
    const MatrixXd features = some_features(50, 6, 5), targets = normal_matrix(50, 3, 6);
    MatrixXd scaled = features;
    scaled.rightCols(5).array() *= 1000;
    scaled.rightCols(5).array() += 4;
    const MatrixXd one = features * LeastSquares(features, 20).solve(targets);
    const MatrixXd two = scaled * LeastSquares(scaled, 20).solve(targets);
    EXPECT_LT((one - two).norm(), 1e-9 * one.norm());
}

TEST(LeastSquares, AHugeRidgePredictsTheMean) {
    const MatrixXd features = some_features(50, 6, 7), targets = normal_matrix(50, 3, 8).array() + 2;
    const MatrixXd predicted = features * LeastSquares(features, 1e15).solve(targets);
    EXPECT_LT((predicted.rowwise() - targets.colwise().mean()).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(LeastSquares, MoreFeaturesThanSamplesReproduceTheSamples) {
    const MatrixXd features = some_features(20, 60, 9), targets = normal_matrix(20, 4, 10);
    EXPECT_LT((features * LeastSquares(features).solve(targets) - targets).norm(), 1e-9 * targets.norm());
}

TEST(LeastSquares, OfAllMinimizersTheSmallest) {
    MatrixXd features = some_features(40, 4, 11);
    features.conservativeResize(40, 7);
    features.col(4) = features.col(1) * -3;
    features.col(5).setConstant(0.1);  // does not vary
    features.col(6).setOnes();
    const MatrixXd targets = normal_matrix(40, 2, 12), weights = LeastSquares(features).solve(targets);
    EXPECT_LT((weights.row(1) + 3 * weights.row(4)).norm(), 1e-9 * weights.row(1).norm());  // equal where standardized
    EXPECT_EQ(weights.row(5).norm(), 0);
    EXPECT_EQ(weights.row(6).norm(), 0);
    const MatrixXd without = features.leftCols(4) * LeastSquares(features.leftCols(4)).solve(targets);
    EXPECT_LT((features * weights - without).norm(), 1e-9 * without.norm());
}

TEST(LeastSquares, OnlyTheConstantFitsTheMean) {
    const MatrixXd targets = normal_matrix(9, 2, 13);
    EXPECT_LT((LeastSquares(MatrixXd::Ones(9, 1)).solve(targets) - targets.colwise().mean()).norm(), 1e-12);
    EXPECT_EQ(LeastSquares(MatrixXd::Ones(1, 1)).solve(MatrixXd::Constant(1, 1, 5.0))(0, 0), 5.0);
}

TEST(LeastSquares, ARidgeLowersTheDegreesOfFreedom) {
    // The trace of the hat matrix: the number of features, less with a ridge.
    const MatrixXd features = some_features(30, 7, 14), targets = MatrixXd::Identity(30, 30);
    EXPECT_NEAR((features * LeastSquares(features).solve(targets)).trace(), 7, 1e-9);
    EXPECT_LT((features * LeastSquares(features, 15).solve(targets)).trace(), 7 - 0.1);
}

TEST(LeastSquares, RefuseWhatTheyCannotUse) {
    MatrixXd features = some_features(10, 3, 15), targets = normal_matrix(10, 2, 16);
    EXPECT_THROW(LeastSquares(features, -1), UsageError);
    EXPECT_THROW(LeastSquares(features, std::numeric_limits<double>::quiet_NaN()), UsageError);
    EXPECT_THROW(LeastSquares(features.rightCols(2)), UsageError);
    EXPECT_THROW(LeastSquares(MatrixXd(0, 3)), UsageError);
    EXPECT_THROW(LeastSquares(features).solve(targets.topRows(9)), UsageError);
    targets(2, 1) = std::numeric_limits<double>::infinity();
    EXPECT_THROW(LeastSquares(features).solve(targets), DataError);
    features(3, 1) = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(LeastSquares{features}, DataError);
}

/// Squared error of samples [begin, end) predicted from the others, with the penalties of all.
double brute_force_error(const MatrixXd& features, const MatrixXd& targets, double ridge, Index begin, Index end) {
    const Index samples = features.rows(), rest = samples - end;
    const auto without = [&](const MatrixXd& all) {
        MatrixXd out(begin + rest, all.cols());
        out << all.topRows(begin), all.bottomRows(rest);
        return out;
    };
    const MatrixXd weights = by_normal_equations(without(features), without(targets), penalties(features, ridge));
    return (features.middleRows(begin, end - begin) * weights - targets.middleRows(begin, end - begin)).squaredNorm();
}

TEST(RidgeChoice, LeavingOneOutIsWhatItSays) {
    const MatrixXd features = some_features(25, 8, 17), targets = normal_matrix(25, 6, 18).array() + 3;
    for (const double candidate : {0.0, 0.01, 1.0}) {
        double expected = 0;
        for (Index i = 0; i < 25; ++i) expected += brute_force_error(features, targets, 25 * candidate, i, i + 1);
        const RidgeChoice choice = leave_one_out(features, targets, std::vector{candidate});
        EXPECT_NEAR(choice.error, expected, 1e-8 * expected) << candidate;
        EXPECT_EQ(choice.candidate, candidate);
        EXPECT_EQ(choice.ridge, 25 * candidate);
    }
}

TEST(RidgeChoice, LeavingBlocksOutIsWhatItSays) {
    const MatrixXd features = some_features(23, 5, 19), targets = normal_matrix(23, 2, 20);
    const std::vector<Index> start{0, 5, 11, 17, 23};  // 4 blocks of 23: floor(b 23 / 4)
    for (const double candidate : {0.0, 0.1}) {
        double expected = 0;
        for (std::size_t b = 0; b < 4; ++b) {
            expected += brute_force_error(features, targets, 23 * candidate, start[b], start[b + 1]);
        }
        EXPECT_NEAR(leave_blocks_out(features, targets, std::vector{candidate}, 4).error, expected, 1e-8 * expected);
    }
}

TEST(RidgeChoice, NoiseNeedsARidgeAndExactDataNone) {
    const MatrixXd features = some_features(60, 40, 21), truth = normal_matrix(40, 20, 22);
    MatrixXd standardized = features;
    for (Index p = 1; p < 40; ++p) standardized.col(p) *= std::pow(10.0, 2 - static_cast<double>(p % 5));
    const std::vector<double> candidates{0, 1e-6, 1e-4, 1e-2, 1};
    EXPECT_EQ(leave_one_out(features, standardized * truth, candidates).candidate, 0);
    EXPECT_EQ(leave_one_out(features, normal_matrix(60, 20, 23), candidates).candidate, 1);
    EXPECT_EQ(leave_blocks_out(features, normal_matrix(60, 20, 23), candidates, 5).candidate, 1);
}

TEST(RidgeChoice, BlocksSeeThroughFramesThatAreAlike) {
    // Ten poses, each held for ten frames with a target of its own that nothing predicts: another frame of the same
    // pose gives it away, another pose does not.
    const MatrixXd poses = some_features(10, 9, 24), values = normal_matrix(10, 3, 25);
    MatrixXd features(100, 9), targets(100, 3);
    for (Index i = 0; i < 100; ++i) features.row(i) = poses.row(i / 10), targets.row(i) = values.row(i / 10);
    const std::vector<double> candidates{1e-6, 1e-3, 1, 100};
    EXPECT_EQ(leave_one_out(features, targets, candidates).candidate, 1e-6);
    EXPECT_GE(leave_blocks_out(features, targets, candidates, 10).candidate, 1);
}

TEST(RidgeChoice, WhatCannotBePredictedIsInfinitelyBad) {
    const MatrixXd features = some_features(12, 30, 26), targets = normal_matrix(12, 2, 27);
    EXPECT_EQ(leave_one_out(features, targets, std::vector<double>{0, 1e-3}).candidate, 1e-3);
    EXPECT_TRUE(std::isinf(leave_one_out(features, targets, std::vector<double>{0}).error));
}

TEST(RidgeChoice, DoesNotDependOnThreads) {
    const MatrixXd features = some_features(40, 9, 28), targets = normal_matrix(40, 5000, 29);
    const std::vector<double> candidates{1e-4, 1e-2};
    const RidgeChoice many = leave_one_out(features, targets, candidates);
    const ThreadLimit one_thread(1);
    EXPECT_EQ(leave_one_out(features, targets, candidates).error, many.error);
}

TEST(RidgeChoice, RefusesWhatItCannotUse) {
    const MatrixXd features = some_features(10, 3, 30), targets = normal_matrix(10, 2, 31);
    EXPECT_THROW(leave_one_out(features, targets, {}), UsageError);
    EXPECT_THROW(leave_one_out(features, targets, std::vector<double>{-1}), UsageError);
    EXPECT_THROW(leave_one_out(features, targets.topRows(5), std::vector<double>{1}), UsageError);
    EXPECT_THROW(leave_blocks_out(features, targets, std::vector<double>{1}, 1), UsageError);
    EXPECT_THROW(leave_blocks_out(features, targets, std::vector<double>{1}, 11), UsageError);
}

}  // namespace
}  // namespace exemplar
