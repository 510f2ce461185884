#pragma once

#include <Eigen/Core>

namespace exemplar {

using RowMajorMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Ridge regression (thesis Eq. 2.19) where rows or inputs are few: returns the weights W (targets x inputs) that
/// minimize the sum over rows i of weight_i |target_i - W z_i|^2, plus ridge * inputs * |W|^2. There is no constant:
/// the caller centers z (rows x inputs) and target (rows x targets). All weights and the ridge are positive.
///
/// LinearTraining serves many rows, folds and ridges; LeastSquares serves many targets and ridges of few rows.
RowMajorMatrix ridge_regression(const RowMajorMatrix& z, const Eigen::VectorXd& weight, const Eigen::MatrixXd& target,
                                double ridge);

}  // namespace exemplar
