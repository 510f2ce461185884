#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>

namespace exemplar {

/// Returns the number of features of polynomial_features: 1 + inputs * degree. Throws UsageError unless degree is 1,
/// 2 or 3.
std::size_t polynomial_feature_count(std::size_t inputs, int degree);

/// Computes phi(x) = [1, x_1 .. x_K, x_1^2 .. x_K^2, x_1^3 .. x_K^3] up to `degree` (thesis Eqs. 5.3, 5.4), for
/// prediction. Throws UsageError unless degree is 1, 2 or 3 and phi has polynomial_feature_count entries.
void polynomial_features(std::span<const float> x, int degree, std::span<float> phi);

/// The same in double for the rows of x (N x K): N x P.
Eigen::MatrixXd polynomial_features(const Eigen::Ref<const Eigen::MatrixXf>& x, int degree);

/// Singular value decomposition U S V^T of features (N x P, the first column all ones) in the coordinates that the
/// penalty is defined in: each other column minus its mean, divided by its standard deviation. Columns that do not
/// vary are left out. Serves any ridge.
class FeatureDecomposition {
  public:
    /// Throws UsageError without rows or columns or for a first column that is not all ones, DataError for a value that
    /// is not finite.
    explicit FeatureDecomposition(const Eigen::Ref<const Eigen::MatrixXd>& features);

    Eigen::Index samples() const { return left_.rows(); }
    /// N x rank: an orthonormal basis of the varying features.
    const Eigen::MatrixXd& left() const { return left_; }
    /// Returns the factors, in [0, 1], that the ridge puts on the fit along each column of left().
    Eigen::VectorXd shrinkage(double ridge) const;
    /// Returns the operator (P x N) that gives the weights V = operator * targets.
    Eigen::MatrixXd solution_operator(double ridge) const;

  private:
    Eigen::VectorXd mean_;     // P, of the columns; 1 for the first
    Eigen::VectorXd inverse_;  // P, one over their standard deviation; 0 for those that do not vary
    Eigen::MatrixXd left_, right_;
    Eigen::VectorXd singular_;
};

/// Solves for the weights V (P x T) that minimize ||targets - features V||^2 + ridge * sum over p > 0 of s_p^2
/// ||V_p||^2 (Eqs. 5.5, 5.8, 5.13), with s_p the standard deviation of feature p. The constant (the first feature,
/// all ones) is not penalized, and units do not matter. If ridge is 0 and features are linearly dependent (or more
/// than the samples), it takes the minimizer with the smallest sum of s_p^2 ||V_p||^2.
class LeastSquares {
  public:
    /// Throws UsageError for a ridge below 0 or a first column that is not all ones, DataError for values that are not
    /// finite.
    explicit LeastSquares(const Eigen::Ref<const Eigen::MatrixXd>& features, double ridge = 0);
    LeastSquares(const FeatureDecomposition& features, double ridge);

    /// Returns V (P x T) for targets (N x T), on all cores. Throws UsageError for another N, DataError for a target
    /// that is not finite.
    Eigen::MatrixXd solve(const Eigen::Ref<const Eigen::MatrixXd>& targets) const;
    /// Returns how much each sample's target influences its own prediction, N values in [0, 1]: the diagonal of the
    /// hat matrix.
    const Eigen::VectorXd& leverage() const { return leverage_; }
    /// Returns the sum of the leverages: the rank of the features without a ridge, less with one.
    double degrees_of_freedom() const { return leverage_.sum(); }

  private:
    Eigen::MatrixXd operator_;  // P x N
    Eigen::VectorXd leverage_;
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
