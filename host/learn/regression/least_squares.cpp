#include "host/learn/regression/least_squares.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "host/core/errors.h"
#include "host/core/parallel.h"
#include "host/learn/decompositions.h"
#include "host/learn/regression/gram.h"

namespace exemplar {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using DoubleRef = Eigen::Ref<const MatrixXd>;

constexpr double k_constant = 1e-10;   // standard deviation over magnitude: below, a feature is its mean and rounding
constexpr double k_dependent = 1e-12;  // of the largest singular value: below, features depend on each other

void check_finite_values(const DoubleRef& values, const char* what) {
    if (values.allFinite()) return;
    for (Index i = 0; i < values.rows(); ++i) {
        if (values.row(i).allFinite()) continue;
        throw DataError(fmt::format("a {} of sample {} is not finite; leave the sample out", what, i));
    }
}

void check_features(const DoubleRef& features) {
    if (features.size() == 0) throw UsageError("there are no samples or no features to fit; give at least one");
    if ((features.col(0).array() != 1.0).any()) {
        throw UsageError("the first feature must be the constant 1, as of polynomial_features");
    }
    check_finite_values(features, "feature");
}

void check_targets(const DoubleRef& targets, Index samples) {
    if (targets.rows() != samples) {
        throw UsageError(fmt::format("there are targets of {} samples, but features of {}", targets.rows(), samples));
    }
    check_finite_values(targets, "target");
}

void check_ridge(double ridge) {
    if (ridge >= 0 && std::isfinite(ridge)) return;
    throw UsageError(fmt::format("a ridge of {} is not a number from 0 up", ridge));
}

/// Singular value decomposition U S V^T of features (N x P, the first column all ones) in the coordinates that the
/// penalty is defined in: each other column minus its mean, divided by its standard deviation. Columns that do not
/// vary are left out. Serves any ridge.
class FeatureDecomposition {
  public:
    explicit FeatureDecomposition(const DoubleRef& features);

    Index samples() const { return left_.rows(); }
    /// N x rank: an orthonormal basis of the varying features.
    const MatrixXd& left() const { return left_; }
    /// Returns the factors, in [0, 1], that the ridge puts on the fit along each column of left().
    VectorXd shrinkage(double ridge) const {
        const auto squared = singular_.array().square();
        return squared / (squared + ridge);
    }
    /// Returns the operator (P x N) that gives the weights V = operator * targets.
    MatrixXd solution_operator(double ridge) const;

  private:
    VectorXd mean_;     // P, of the columns; 1 for the first
    VectorXd inverse_;  // P, one over their standard deviation; 0 for those that do not vary
    MatrixXd left_, right_;
    VectorXd singular_;
};

FeatureDecomposition::FeatureDecomposition(const DoubleRef& features) {
    check_features(features);
    mean_ = features.colwise().mean();
    inverse_ = VectorXd::Zero(features.cols());
    std::vector<Index> varying;
    for (Index p = 1; p < features.cols(); ++p) {
        const auto deviations = features.col(p).array() - mean_(p);
        const double deviation = std::sqrt(deviations.square().mean());
        if (!(deviation > k_constant * features.col(p).cwiseAbs().maxCoeff())) continue;
        inverse_(p) = 1 / deviation;
        varying.push_back(p);
    }
    MatrixXd standardized(features.rows(), static_cast<Index>(varying.size()));
    for (std::size_t v = 0; v < varying.size(); ++v) {
        const Index p = varying[v];
        standardized.col(static_cast<Index>(v)) = (features.col(p).array() - mean_(p)) * inverse_(p);
    }
    if (varying.empty()) {
        left_.resize(features.rows(), 0), right_.resize(features.cols(), 0);
        return;
    }
    const SingularValues svd = singular_values(standardized);
    const Index rank = (svd.values.array() > k_dependent * svd.values(0)).count();
    singular_ = svd.values.head(rank);
    left_ = svd.u.leftCols(rank);
    right_ = MatrixXd::Zero(features.cols(), rank);
    for (std::size_t v = 0; v < varying.size(); ++v) {
        right_.row(varying[v]) = svd.v.row(static_cast<Index>(v)).head(rank);
    }
}

MatrixXd FeatureDecomposition::solution_operator(double ridge) const {
    const VectorXd gain = shrinkage(ridge).cwiseQuotient(singular_);
    MatrixXd out = inverse_.asDiagonal() * right_ * gain.asDiagonal() * left_.transpose();
    // The constant makes up for the centering: the mean target minus the mean prediction.
    out.row(0) = -mean_.transpose() * out;
    out.row(0).array() += 1.0 / static_cast<double>(samples());
    return out;
}

/// Returns the sum of the squared errors of the samples [begin, end) when they are left out: their residuals r
/// become (I - H_BB)^-1 r. `residual` is I - H, `gram` is targets times their transpose. Infinite if the other
/// samples do not determine the prediction.
double left_out_error(const MatrixXd& residual, const MatrixXd& gram, Index begin, Index end) {
    constexpr double k_undetermined = 1e-10;
    const Index count = end - begin;
    const SymmetricEigen block = symmetric_eigen(residual.block(begin, begin, count, count));
    if (block.values(0) < k_undetermined) return std::numeric_limits<double>::infinity();
    const MatrixXd rows =
        block.values.cwiseInverse().asDiagonal() * block.vectors.transpose() * residual.middleRows(begin, count);
    return std::max(0.0, (rows * gram).cwiseProduct(rows).sum());
}

double error_of_candidate(const FeatureDecomposition& features, const MatrixXd& gram, double ridge,
                          std::size_t blocks) {
    const Index samples = features.samples();
    const double share = 1.0 / static_cast<double>(samples);
    const MatrixXd residual = MatrixXd::Identity(samples, samples) - MatrixXd::Constant(samples, samples, share) -
                              features.left() * features.shrinkage(ridge).asDiagonal() * features.left().transpose();
    const auto start = [&](std::size_t b) {
        return static_cast<Index>(b * static_cast<std::size_t>(samples) / blocks);
    };
    double error = 0;
    for (std::size_t b = 0; b < blocks; ++b) error += left_out_error(residual, gram, start(b), start(b + 1));
    return error;
}

}  // namespace

MatrixXd polynomial_features(const Eigen::Ref<const Eigen::MatrixXf>& x, int degree) {
    if (degree < 1 || degree > 3) throw UsageError(fmt::format("a degree of {} is not 1, 2 or 3", degree));
    MatrixXd phi(x.rows(), 1 + degree * x.cols());
    phi.col(0).setOnes();
    const MatrixXd base = x.cast<double>();
    if (x.cols() == 0) return phi;
    phi.middleCols(1, x.cols()) = base;
    for (Index d = 1; d < degree; ++d) {
        phi.middleCols(1 + d * x.cols(), x.cols()) =
            phi.middleCols(1 + (d - 1) * x.cols(), x.cols()).cwiseProduct(base);
    }
    return phi;
}

LeastSquares::LeastSquares(const DoubleRef& features, double ridge) {
    check_ridge(ridge);
    operator_ = FeatureDecomposition(features).solution_operator(ridge);
}

MatrixXd LeastSquares::solve(const DoubleRef& targets) const {
    check_targets(targets, operator_.cols());
    MatrixXd out(operator_.rows(), targets.cols());
    constexpr Index k_block = 256;
    parallel_for(static_cast<std::size_t>((targets.cols() + k_block - 1) / k_block), [&](std::size_t b) {
        const Index begin = static_cast<Index>(b) * k_block, count = std::min(k_block, targets.cols() - begin);
        out.middleCols(begin, count).noalias() = operator_ * targets.middleCols(begin, count);
    });
    return out;
}

RidgeChoice leave_one_out(const DoubleRef& features, const DoubleRef& targets, std::span<const double> candidates) {
    return leave_blocks_out(features, targets, candidates, static_cast<std::size_t>(features.rows()));
}

RidgeChoice leave_blocks_out(const DoubleRef& features, const DoubleRef& targets, std::span<const double> candidates,
                             std::size_t blocks) {
    if (candidates.empty()) throw UsageError("there are no candidates for the ridge; give at least one");
    for (const double candidate : candidates) check_ridge(candidate);
    const FeatureDecomposition decomposed(features);
    const Index samples = decomposed.samples();
    check_targets(targets, samples);
    if (blocks < 2 || blocks > static_cast<std::size_t>(samples)) {
        throw UsageError(
            fmt::format("{} samples cannot be left out in {} blocks; give 2 to {}", samples, blocks, samples));
    }
    const Eigen::RowVectorXd mean = targets.colwise().mean();
    const MatrixXd gram = gram_of_chunks(samples, targets.cols(), [&](Index begin, Index end) -> MatrixXd {
        return targets.middleCols(begin, end - begin).rowwise() - mean.segment(begin, end - begin);
    });
    std::vector<double> errors(candidates.size());
    parallel_for(candidates.size(), [&](std::size_t c) {
        errors[c] = error_of_candidate(decomposed, gram, candidates[c] * static_cast<double>(samples), blocks);
    });
    RidgeChoice best{0, -1, std::numeric_limits<double>::infinity()};
    for (std::size_t c = 0; c < candidates.size(); ++c) {
        if (errors[c] > best.error || (errors[c] == best.error && candidates[c] < best.candidate)) continue;
        best = {candidates[c] * static_cast<double>(samples), candidates[c], errors[c]};
    }
    return best;
}

}  // namespace exemplar
