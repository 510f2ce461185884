#include "host/learn/regression/ridge.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "tests/learn/regression/normal_matrix.h"

namespace exemplar {
namespace {

TEST(RidgeRegression, ShrinksTheWeightOfOneInput) {
    // One input: W = sum of w z y over (sum of w z^2 + ridge).
    RowMajorMatrix z(3, 1);
    z << 1, -2, 1;
    const Eigen::Vector3d weight(1, 2, 1);
    const Eigen::MatrixXd target = 3 * z;
    EXPECT_NEAR(ridge_regression(z, weight, target, 10)(0, 0), 30.0 / 20.0, 1e-14);
    EXPECT_NEAR(ridge_regression(z, weight, target, 1e-12)(0, 0), 3, 1e-11);
}

TEST(RidgeRegression, OneRowSpreadsOverItsInputs) {
    // One row: W lies along z; W z = y |z|^2 / (|z|^2 + ridge D / w).
    RowMajorMatrix z(1, 4);
    z << 1, -1, 2, 0;
    const RowMajorMatrix found =
        ridge_regression(z, Eigen::VectorXd::Constant(1, 2.0), Eigen::MatrixXd::Constant(1, 1, 5.0), 3);
    EXPECT_LT((found - 5.0 / (6 + 3 * 4 / 2.0) * z).norm(), 1e-14);
}

TEST(RidgeRegression, BothFormsSolveTheNormalEquations) {
    for (const Eigen::Index rows : {3, 7, 8, 30}) {
        const RowMajorMatrix z = normal_matrix(rows, 7, 1);
        const Eigen::VectorXd weight = normal_matrix(rows, 1, 2).cwiseAbs2().array() + 0.1;
        const Eigen::MatrixXd target = normal_matrix(rows, 2, 3);
        const double ridge = 0.05;
        Eigen::MatrixXd normal = z.transpose() * weight.asDiagonal() * z;
        normal.diagonal().array() += 7 * ridge;
        const Eigen::MatrixXd expected = normal.inverse() * z.transpose() * weight.asDiagonal() * target;
        EXPECT_LT((ridge_regression(z, weight, target, ridge).transpose() - expected).norm(), 1e-10 * expected.norm())
            << rows;
    }
}

}  // namespace
}  // namespace exemplar
