#include "host/learn/regression/reduced_rank.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "host/core/errors.h"
#include "host/core/random.h"

namespace exemplar {
namespace {

using Eigen::Index;
using Eigen::MatrixXf;

MatrixXf centered_normal(Index rows, Index cols, std::uint64_t seed) {
    Random random(seed);
    MatrixXf values = MatrixXf::NullaryExpr(rows, cols, [&] { return static_cast<float>(random.normal()); });
    values.rowwise() -= values.colwise().mean().eval();
    return values;
}

MatrixXf predicted(const ReducedRank& map, const MatrixXf& x) {
    return x * map.projection.transpose() * map.basis.transpose();
}

TEST(ReducedRank, FindsAMapOfThatRank) {
    const MatrixXf x = centered_normal(60, 9, 1),
                   map = centered_normal(9, 2, 2) * centered_normal(30, 2, 3).transpose();
    const ReducedRank cut = fit_reduced_rank(x, x * map, 1e-9, 2);
    ASSERT_EQ(cut.explained.size(), 2);
    EXPECT_LT((predicted(cut, x) - x * map).norm(), 1e-3f * (x * map).norm());
}

TEST(ReducedRank, ComponentsHaveUnitVarianceAndAreNotCorrelated) {
    const MatrixXf x = centered_normal(80, 12, 4), y = x * centered_normal(12, 20, 5);
    const ReducedRank found = fit_reduced_rank(x, y, 1e-6, 5);
    const MatrixXf z = x * found.projection.transpose();
    EXPECT_LT((z.transpose() * z / 80 - MatrixXf::Identity(5, 5)).norm(), 1e-3f);
    for (Index c = 0; c < 5; ++c) EXPECT_NEAR(found.basis.col(c).squaredNorm() / found.explained[c], 1, 1e-3);
}

TEST(ReducedRank, PrefersWhatMattersOverWhatVaries) {
    // The first input varies a hundred times as much as the second, but only the second matters.
    MatrixXf x = centered_normal(50, 2, 6);
    x.col(0) *= 100;
    const ReducedRank found = fit_reduced_rank(x, x.col(1), 1e-9, 1);
    ASSERT_EQ(found.explained.size(), 1);
    EXPECT_LT((predicted(found, x) - x.col(1)).norm(), 0.01f * x.col(1).norm());
}

TEST(ReducedRank, OfFullRankIsRidgeRegression) {
    const MatrixXf x = centered_normal(40, 6, 7), y = centered_normal(40, 3, 8);
    const double ridge = 0.02;
    Eigen::MatrixXd normal = (x.transpose() * x).cast<double>();
    normal.diagonal().array() += ridge * x.cast<double>().squaredNorm() / 40;
    const Eigen::MatrixXd weights = normal.ldlt().solve((x.transpose() * y).cast<double>());
    const MatrixXf expected = (x.cast<double>() * weights).cast<float>();
    EXPECT_LT((predicted(fit_reduced_rank(x, y, ridge, 3), x) - expected).norm(), 1e-4f * expected.norm());
}

TEST(ReducedRank, OfWhatDoesNotVaryHasNoComponents) {
    const ReducedRank found = fit_reduced_rank(MatrixXf::Zero(30, 4), MatrixXf::Zero(30, 5), 1e-3, 3);
    EXPECT_EQ(found.projection.rows(), 0);
    EXPECT_EQ(found.basis.rows(), 5);
    EXPECT_EQ(fit_reduced_rank(centered_normal(30, 4, 9), MatrixXf::Zero(30, 5), 1e-3, 3).explained.size(), 0);
}

TEST(ReducedRank, RefusesWhatDoesNotFit) {
    EXPECT_THROW(fit_reduced_rank(MatrixXf::Zero(3, 4), MatrixXf::Zero(2, 5), 1e-3, 3), UsageError);
    EXPECT_THROW(fit_reduced_rank(MatrixXf::Zero(3, 4), MatrixXf::Zero(3, 5), 0, 3), UsageError);
}

}  // namespace
}  // namespace exemplar
