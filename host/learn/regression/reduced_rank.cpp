#include "host/learn/regression/reduced_rank.h"

#include <algorithm>
#include <cmath>

#include "host/core/errors.h"
#include "host/learn/decompositions.h"

namespace exemplar {

namespace {

/// Below this share of the strongest, a component is rounding.
constexpr double k_min_explained = 1e-10;

}  // namespace

ReducedRank fit_reduced_rank(const Eigen::Ref<const Eigen::MatrixXf>& x, const Eigen::Ref<const Eigen::MatrixXf>& y,
                             double ridge, std::size_t most) {
    if (x.rows() != y.rows() || x.rows() == 0)
        throw UsageError("reduced-rank regression needs as many outputs as inputs, and some");
    if (!(ridge > 0)) throw UsageError("the ridge of a reduced-rank regression must be positive");
    ReducedRank result{Eigen::MatrixXf(0, x.cols()), Eigen::MatrixXf(y.cols(), 0), {}};

    // Computed in the space of samples, which are fewer than inputs.
    Eigen::MatrixXd gram = x.cast<double>() * x.cast<double>().transpose();
    const double penalty = ridge * gram.trace() / static_cast<double>(x.rows());
    if (!(penalty > 0)) return result;
    gram.diagonal().array() += penalty;
    const Eigen::MatrixXd targets = y.cast<double>();
    const Eigen::MatrixXd dual = solve_ldlt(gram, targets);
    const Eigen::MatrixXd fitted = targets - penalty * dual;

    const SymmetricEigen eigen = symmetric_eigen(fitted * fitted.transpose());
    const Eigen::VectorXd variance = eigen.values.reverse() / static_cast<double>(x.rows());
    Eigen::Index count = 0;
    while (count < variance.size() && count < static_cast<Eigen::Index>(most) &&
           variance[count] > k_min_explained * variance[0])
        ++count;
    const Eigen::MatrixXd samples = eigen.vectors.rightCols(count).rowwise().reverse();
    const Eigen::VectorXd deviation = variance.head(count).cwiseSqrt();
    // Directions of the outputs, of unit length; the scores of the samples along them are `samples`, up to their scale.
    const Eigen::MatrixXd directions =
        fitted.transpose() * samples *
        (deviation * std::sqrt(static_cast<double>(x.rows()))).cwiseInverse().asDiagonal();
    result.basis = (directions * deviation.asDiagonal()).cast<float>();
    result.projection =
        ((dual * directions * deviation.cwiseInverse().asDiagonal()).transpose() * x.cast<double>()).cast<float>();
    result.explained = variance.head(count).cast<float>();
    return result;
}

}  // namespace exemplar
