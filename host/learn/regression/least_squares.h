#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>

namespace exemplar {

/// How many features polynomial_features gives: 1 + inputs * degree. Throws UsageError unless degree is 1, 2 or 3.
std::size_t polynomial_feature_count(std::size_t inputs, int degree);

/// phi(x) = [1, x_1 .. x_K, x_1^2 .. x_K^2, x_1^3 .. x_K^3] up to `degree` (thesis Eqs. 5.3, 5.4), for run time.
/// Throws UsageError for another degree than 1, 2, 3 or if phi has not polynomial_feature_count entries.
void polynomial_features(std::span<const float> x, int degree, std::span<float> phi);

/// The same in double for the rows of x (N x K): N x P.
Eigen::MatrixXd polynomial_features(const Eigen::Ref<const Eigen::MatrixXf>& x, int degree);

/// Features (N x P, the first column all ones) in the coordinates that the penalty is defined in: each other column
/// less its mean over its standard deviation (columns that do not vary are left out), as U S V^T. Serves any ridge.
class FeatureDecomposition {
  public:
    /// Throws UsageError without rows or columns or for a first column that is not all ones, DataError for a value that
    /// is not finite.
    explicit FeatureDecomposition(const Eigen::Ref<const Eigen::MatrixXd>& features);

    Eigen::Index samples() const { return left_.rows(); }
    /// N x rank: an orthonormal basis of the varying features.
    const Eigen::MatrixXd& left() const { return left_; }
    /// By how much the ridge shrinks the fit along each column of left(), in [0, 1].
    Eigen::VectorXd shrinkage(double ridge) const;
    /// P x N: weights V = operator * targets.
    Eigen::MatrixXd solution_operator(double ridge) const;

  private:
    Eigen::VectorXd mean_;     // P, of the columns; 1 for the first
    Eigen::VectorXd inverse_;  // P, over their standard deviation; 0 for those that do not vary
    Eigen::MatrixXd left_, right_;
    Eigen::VectorXd singular_;
};

/// Weights V (P x T) that minimize ||targets - features V||^2 + ridge * sum over p > 0 of s_p^2 ||V_p||^2 (Eqs. 5.5,
/// 5.8, 5.13), s_p the standard deviation of feature p: the constant (the first feature, all ones) is not penalized,
/// and units do not matter. Where features depend on each other (or are more than the samples) and ridge is 0, of all
/// minimizers the one with the least sum of s_p^2 ||V_p||^2.
class LeastSquares {
  public:
    /// Throws UsageError for a ridge below 0 or a first column that is not all ones, DataError for values that are not
    /// finite.
    explicit LeastSquares(const Eigen::Ref<const Eigen::MatrixXd>& features, double ridge = 0);
    LeastSquares(const FeatureDecomposition& features, double ridge);

    /// V (P x T) for targets (N x T), on all cores. Throws UsageError for another N, DataError for a target that is not
    /// finite.
    Eigen::MatrixXd solve(const Eigen::Ref<const Eigen::MatrixXd>& targets) const;
    /// How much each sample's target draws its own prediction, N values in [0, 1]: the diagonal of the hat matrix.
    const Eigen::VectorXd& leverage() const { return leverage_; }
    /// Sum of the leverages: the rank of the features without a ridge, less with one.
    double degrees_of_freedom() const { return leverage_.sum(); }

  private:
    Eigen::MatrixXd operator_;  // P x N
    Eigen::VectorXd leverage_;
};

/// A ridge that was chosen by leaving samples out.
struct RidgeChoice {
    double ridge = 0;      ///< for LeastSquares: N times the candidate
    double candidate = 0;  ///< the one chosen
    double error = 0;      ///< sum over targets and samples of the squared error of samples left out
};

/// The ridge N * candidate with the least error when each sample in turn is left out, over all targets (N x T), in
/// closed form by the hat matrix (the s_p stay those of all samples). A candidate under which a sample left out cannot
/// be predicted (features no less than samples, no ridge) has an infinite error; of equal errors the largest candidate
/// wins. Throws UsageError without candidates or for one below 0, and what LeastSquares throws.
RidgeChoice leave_one_out(const Eigen::Ref<const Eigen::MatrixXd>& features,
                          const Eigen::Ref<const Eigen::MatrixXd>& targets, std::span<const double> candidates);

/// The same leaving out runs of samples, `blocks` (2 to N) of about equal size: neighboring frames of an animation are
/// alike, so a single one left out is predicted from its neighbors. Throws UsageError for blocks out of range.
RidgeChoice leave_blocks_out(const Eigen::Ref<const Eigen::MatrixXd>& features,
                             const Eigen::Ref<const Eigen::MatrixXd>& targets, std::span<const double> candidates,
                             std::size_t blocks);

}  // namespace exemplar
