#include "host/learn/components/pca.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "host/core/errors.h"
#include "host/core/parallel.h"
#include "host/learn/decompositions.h"
#include "host/learn/regression/gram.h"

namespace exemplar {
namespace {

using Eigen::Index;
using Samples = Eigen::Ref<const Eigen::MatrixXf>;

constexpr double k_relative_noise = 1e-12;  // of the largest variance: below, the Gram matrix is rounding
constexpr double k_absolute_noise = 1e-28;  // of the mean squared length: below, so is the centering

struct Spectrum {
    Eigen::VectorXd variance;  // falling
    Eigen::MatrixXd vectors;   // of the Gram matrix, in the same order
    double total = 0;
};

void check_share(double share) {
    if (share > 0 && share <= 1) return;
    throw UsageError(fmt::format("a share of the variance of {} is not in (0, 1]", share));
}

void check_samples(const Samples& samples) {
    if (samples.rows() == 0) throw UsageError("there are no samples to find components of; give at least one");
    if (samples.allFinite()) return;
    for (Index i = 0; i < samples.rows(); ++i) {
        for (Index j = 0; j < samples.cols(); ++j) {
            if (std::isfinite(samples(i, j))) continue;
            throw DataError(fmt::format("value {} of sample {} is not finite; leave the sample out", j, i));
        }
    }
}

void check_columns(Index found, Index expected, const char* what) {
    if (found == expected) return;
    throw UsageError(
        fmt::format("there are {} {} per row, but the components were found for {}", found, what, expected));
}

Eigen::VectorXd column_means(const Samples& samples) {
    Eigen::VectorXd mean(samples.cols());
    for (Index j = 0; j < samples.cols(); ++j) mean(j) = samples.col(j).cast<double>().mean();
    return mean;
}

Eigen::MatrixXd centered_columns(const Samples& samples, const Eigen::VectorXd& mean, Index begin, Index end) {
    const Index count = end - begin;
    return samples.middleCols(begin, count).cast<double>().rowwise() - mean.segment(begin, count).transpose();
}

/// Returns the smaller Gram matrix of the centered samples: by sample or by value.
Eigen::MatrixXd smaller_gram(const Samples& samples, const Eigen::VectorXd& mean, bool by_sample) {
    if (by_sample) {
        return gram_of_chunks(samples.rows(), samples.cols(),
                              [&](Index begin, Index end) { return centered_columns(samples, mean, begin, end); });
    }
    return gram_of_chunks(samples.cols(), samples.rows(), [&](Index begin, Index end) -> Eigen::MatrixXd {
        return samples.middleRows(begin, end - begin).transpose().cast<double>().colwise() - mean;
    });
}

Spectrum spectrum_of(const Eigen::MatrixXd& gram, Index samples) {
    if (gram.size() == 0) return {};
    const SymmetricEigen eigen = symmetric_eigen(gram);
    Spectrum out{eigen.values.reverse() / static_cast<double>(samples), eigen.vectors.rowwise().reverse(),
                 gram.trace() / static_cast<double>(samples)};
    out.variance = out.variance.cwiseMax(0.0);
    return out;
}

/// Counts the leading variances that exceed rounding noise.
Index varying(const Spectrum& spectrum, double mean_square) {
    if (spectrum.variance.size() == 0) return 0;
    const double floor = std::max(k_relative_noise * spectrum.variance(0), k_absolute_noise * mean_square);
    return (spectrum.variance.array() > floor).count();
}

/// Returns unit directions from the eigenvectors of the samples' Gram matrix. Those of small variance are not quite
/// orthogonal; the Cholesky factor of their own Gram matrix corrects that (as Gram-Schmidt would, largest first).
Eigen::MatrixXd directions_from_samples(const Samples& samples, const Eigen::VectorXd& mean, const Spectrum& spectrum,
                                        Index count) {
    if (count == 0) return Eigen::MatrixXd(samples.cols(), 0);
    const Eigen::VectorXd norms = (spectrum.variance.head(count) * static_cast<double>(samples.rows())).cwiseSqrt();
    const Eigen::MatrixXd weights = spectrum.vectors.leftCols(count) * norms.cwiseInverse().asDiagonal();
    constexpr Index k_block = 1024;
    const Index values = samples.cols();
    Eigen::MatrixXd basis(values, count);
    const auto for_blocks = [&](const auto& body) {
        parallel_for(static_cast<std::size_t>((values + k_block - 1) / k_block), [&](std::size_t b) {
            const Index begin = static_cast<Index>(b) * k_block;
            body(begin, std::min(values, begin + k_block));
        });
    };
    for_blocks([&](Index begin, Index end) {
        basis.middleRows(begin, end - begin).noalias() =
            centered_columns(samples, mean, begin, end).transpose() * weights;
    });
    const Eigen::LLT<Eigen::MatrixXd> straighten(gram_of_chunks(count, values, [&](Index begin, Index end) {
        return Eigen::MatrixXd(basis.middleRows(begin, end - begin).transpose());
    }));
    for_blocks([&](Index begin, Index end) {
        auto rows = basis.middleRows(begin, end - begin);
        straighten.matrixU().solveInPlace<Eigen::OnTheRight>(rows);
    });
    return basis;
}

void fix_signs(Eigen::MatrixXd& basis) {
    for (Index d = 0; d < basis.cols(); ++d) {
        Index largest = 0;
        basis.col(d).cwiseAbs().maxCoeff(&largest);
        if (basis(largest, d) < 0) basis.col(d) *= -1;
    }
}

}  // namespace

Eigen::MatrixXf Pca::project(const Samples& samples) const {
    check_columns(samples.cols(), mean.size(), "values");
    return (samples.rowwise() - mean.transpose()) * basis;
}

Eigen::MatrixXf Pca::restore(const Samples& components) const {
    check_columns(components.cols(), basis.cols(), "components");
    return (components * basis.transpose()).rowwise() + mean.transpose();
}

std::size_t components_for_variance(const Eigen::Ref<const Eigen::VectorXd>& variance, double total, double share) {
    check_share(share);
    if (total <= 0) return 0;
    // Summing up would lose the last ones in rounding.
    if (share == 1) return static_cast<std::size_t>((variance.array() > 0).count());
    double sum = 0;
    for (Index d = 0; d < variance.size(); ++d) {
        sum += variance(d);
        if (sum >= share * total) return static_cast<std::size_t>(d) + 1;
    }
    return static_cast<std::size_t>(variance.size());
}

Pca fit_pca(const Samples& samples, double share, std::size_t most) {
    check_share(share);
    check_samples(samples);
    const Eigen::VectorXd mean = column_means(samples);
    const bool by_sample = samples.rows() < samples.cols();
    const Spectrum spectrum = spectrum_of(smaller_gram(samples, mean, by_sample), samples.rows());
    const double mean_square = samples.cast<double>().squaredNorm() / static_cast<double>(samples.rows());
    const Index kept = varying(spectrum, mean_square);
    const std::size_t wanted = components_for_variance(spectrum.variance.head(kept), spectrum.total, share);
    const auto count = static_cast<Index>(std::min(wanted, most));
    Eigen::MatrixXd basis = by_sample ? directions_from_samples(samples, mean, spectrum, count)
                                      : Eigen::MatrixXd(spectrum.vectors.leftCols(count));
    fix_signs(basis);
    return {mean.cast<float>(), basis.cast<float>(), spectrum.variance.head(count), spectrum.total};
}

}  // namespace exemplar
