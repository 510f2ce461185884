#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>

namespace exemplar {

/// Computes phi(x) = [1, x_1 .. x_K, x_1^2 .. x_K^2, x_1^3 .. x_K^3] up to `degree` (thesis Eqs. 5.3, 5.4) for the rows
/// of x (N x K): N x P, P = 1 + K degree. Throws UsageError unless degree is 1, 2 or 3.
Eigen::MatrixXd polynomial_features(const Eigen::Ref<const Eigen::MatrixXf>& x, int degree);

/// Solves for the weights V (P x T) that minimize ||targets - features V||^2 + ridge * sum over p > 0 of s_p^2
/// ||V_p||^2 (Eqs. 5.5, 5.8, 5.13), with s_p the standard deviation of feature p. The constant (the first feature,
/// all ones) is not penalized, and units do not matter. If ridge is 0 and features are linearly dependent (or more
/// than the samples), it takes the minimizer with the smallest sum of s_p^2 ||V_p||^2.
class LeastSquares {
  public:
    /// Throws UsageError for a ridge below 0 or a first column that is not all ones, DataError for values that are not
    /// finite.
    explicit LeastSquares(const Eigen::Ref<const Eigen::MatrixXd>& features, double ridge = 0);

    /// Returns V (P x T) for targets (N x T), on all cores. Throws UsageError for another N, DataError for a target
    /// that is not finite.
    Eigen::MatrixXd solve(const Eigen::Ref<const Eigen::MatrixXd>& targets) const;

  private:
    Eigen::MatrixXd operator_;  // P x N
};

/// A ridge that was chosen by cross-validation.
struct RidgeChoice {
    double ridge = 0;      ///< for LeastSquares: N times the candidate
    double candidate = 0;  ///< the one chosen
    double error = 0;      ///< sum over targets and samples of the squared error of samples left out
};

/// Returns the ridge N * candidate with the smallest error when each sample in turn is left out, over all targets (N
/// x T), in closed form by the hat matrix (the s_p stay those of all samples). A candidate under which a left-out
/// sample cannot be predicted (no ridge and at least as many features as samples) has an infinite error; among equal
/// errors the largest candidate wins. Throws UsageError without candidates or for one below 0, and what LeastSquares
/// throws.
RidgeChoice leave_one_out(const Eigen::Ref<const Eigen::MatrixXd>& features,
                          const Eigen::Ref<const Eigen::MatrixXd>& targets, std::span<const double> candidates);

/// The same, leaving out `blocks` (2 to N) runs of samples of about equal size: neighboring frames of an animation
/// are alike, so a single left-out one is predicted from its neighbors. Throws UsageError for blocks out of range.
RidgeChoice leave_blocks_out(const Eigen::Ref<const Eigen::MatrixXd>& features,
                             const Eigen::Ref<const Eigen::MatrixXd>& targets, std::span<const double> candidates,
                             std::size_t blocks);

}  // namespace exemplar
