#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <limits>

namespace exemplar {

constexpr std::size_t k_unlimited = std::numeric_limits<std::size_t>::max();

/// Principal components (thesis Sec. 2.5.1, Eq. 2.81): the directions of largest variance of samples with M values.
struct Pca {
    Eigen::VectorXf mean;       ///< M values
    Eigen::MatrixXf basis;      ///< M x D, orthonormal columns; the entry of largest magnitude in each is positive
    Eigen::VectorXd variance;   ///< D, falling: variance (divided by N) along each column
    double total_variance = 0;  ///< of the samples, summed over all directions, kept or not

    /// Projects N x M samples to N x D components. Throws UsageError unless samples have M values.
    Eigen::MatrixXf project(const Eigen::Ref<const Eigen::MatrixXf>& samples) const;
    /// Restores N x M samples from N x D components. Throws UsageError unless there are D components.
    Eigen::MatrixXf restore(const Eigen::Ref<const Eigen::MatrixXf>& components) const;
};

/// Returns the smallest number of leading components whose variances add up to `share` of the total: all that vary
/// for share 1, all if they do not add up, 0 if nothing varies. Throws UsageError unless share is in (0, 1].
std::size_t components_for_variance(const Eigen::Ref<const Eigen::VectorXd>& variance, double total, double share);

/// Computes the principal components of `samples` (N x M, one sample per row) from the smaller of the two Gram
/// matrices, in double: as many as carry `share` of the variance, at most `most`. Variances below 1e-12 of the
/// largest, or below 1e-28 of the samples' mean squared length, are rounding noise and are left out even for share
/// 1. Samples that do not vary have no components. The result does not depend on the number of threads.
/// Throws UsageError without samples or for a share outside of (0, 1], DataError for a value that is not finite.
Pca fit_pca(const Eigen::Ref<const Eigen::MatrixXf>& samples, double share, std::size_t most = k_unlimited);

}  // namespace exemplar
