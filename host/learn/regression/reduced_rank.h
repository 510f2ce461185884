#pragma once

#include <Eigen/Core>
#include <cstddef>

namespace exemplar {

/// A linear map of low rank: y - mean(y) = basis z with z = projection (x - mean(x)), each z of unit variance.
struct ReducedRank {
    Eigen::MatrixXf projection;  ///< components x inputs
    Eigen::MatrixXf basis;       ///< outputs x components
    Eigen::VectorXf explained;   ///< variance of the outputs that each component predicts, falling
};

/// Reduced-rank ridge regression (Izenman 1975): finds the linear map of rank `most` whose predictions are nearest
/// to those of the full ridge regression of y (N x Q) on x (N x D), both centered by the caller. `ridge` is relative
/// to the mean squared norm of the rows of x. Components that predict nothing are left out. Throws UsageError if the
/// rows do not match or the ridge is not positive.
ReducedRank fit_reduced_rank(const Eigen::Ref<const Eigen::MatrixXf>& x, const Eigen::Ref<const Eigen::MatrixXf>& y,
                             double ridge, std::size_t most);

}  // namespace exemplar
