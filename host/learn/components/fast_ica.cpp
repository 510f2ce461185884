#include "host/learn/components/fast_ica.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "host/core/errors.h"
#include "host/learn/components/ica_rotation.h"

namespace exemplar {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Samples = Eigen::Ref<const Eigen::MatrixXf>;

/// Samples along the first D principal directions, in double: floats would lose weak directions beside strong ones.
struct Projection {
    MatrixXd basis;       // M x D
    MatrixXd components;  // N x D, zero mean
};

/// Mixing and unmixing in double, before components are sorted and signed.
struct Mixture {
    MatrixXd mixing;     // M x D
    MatrixXd unmixing;   // D x M
    MatrixXd sources;    // N x D
    VectorXd asymmetry;  // D, its sign is that of the component
    IcaRotation rotation;
};

void check_ica_options(const IcaOptions& options) {
    if (options.iterations < 1) throw UsageError("independent components take at least one iteration");
    if (!(options.tolerance > 0)) throw UsageError("the tolerance of independent components must be above 0");
}

Projection project_samples(const Pca& pca, const Samples& samples) {
    Projection out{pca.basis.cast<double>(), {}};
    out.components.resize(samples.rows(), pca.basis.cols());
    const Eigen::RowVectorXd mean = pca.mean.cast<double>().transpose();
    constexpr Index k_block = 64;
    for (Index begin = 0; begin < samples.rows(); begin += k_block) {
        const Index size = std::min(k_block, samples.rows() - begin);
        const MatrixXd centered = samples.middleRows(begin, size).cast<double>().rowwise() - mean;
        out.components.middleRows(begin, size).noalias() = centered * out.basis;
    }
    out.components.rowwise() -= out.components.colwise().mean().eval();
    return out;
}

/// The Cholesky factor of the components' covariance: nearly the diagonal of their standard deviations, but exact for
/// these components, so that the sources are white to rounding.
MatrixXd whitening_factor(const MatrixXd& components) {
    const MatrixXd covariance = components.transpose() * components / static_cast<double>(components.rows());
    const Eigen::LLT<MatrixXd> factor(covariance);
    if (factor.info() != Eigen::Success) {
        throw UsageError("the samples hardly vary along some principal components; ask for less of the variance");
    }
    return factor.matrixL();
}

VectorXd third_moments(const MatrixXd& columns) {
    return columns.array().cube().colwise().sum().transpose();
}

Mixture rotate_sources(const Projection& data, const IcaOptions& options) {
    const MatrixXd factor = whitening_factor(data.components);
    const auto lower = factor.triangularView<Eigen::Lower>();
    const MatrixXd white = lower.solve(data.components.transpose()).transpose();
    IcaRotation rotation = find_rotation(white, options);
    const MatrixXd sources = white * rotation.rows.transpose();
    return {data.basis * (factor * rotation.rows.transpose()), rotation.rows * lower.solve(data.basis.transpose()),
            sources, third_moments(sources), std::move(rotation)};
}

Mixture rotate_basis(const Projection& data, const IcaOptions& options) {
    const double scale = std::sqrt(static_cast<double>(data.basis.rows()));  // to unit second moments
    IcaRotation rotation = find_rotation(data.basis * scale, options);
    const MatrixXd basis = data.basis * rotation.rows.transpose();
    const MatrixXd projections = data.components * rotation.rows.transpose();
    const VectorXd deviation =
        (projections.colwise().squaredNorm().transpose() / static_cast<double>(projections.rows())).cwiseSqrt();
    const VectorXd inverse = deviation.cwiseInverse();
    return {basis * deviation.asDiagonal(), inverse.asDiagonal() * basis.transpose(),
            projections * inverse.asDiagonal(), third_moments(basis), std::move(rotation)};
}

/// Sorts components by falling length of their mixing column and turns each to positive asymmetry.
Ica in_order(const Mixture& mixture, const Eigen::VectorXf& mean) {
    const VectorXd lengths = mixture.mixing.colwise().norm();
    std::vector<Index> order(static_cast<std::size_t>(lengths.size()));
    std::iota(order.begin(), order.end(), Index{0});
    std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return lengths(a) > lengths(b); });
    const Index count = lengths.size();
    Ica out{mean,
            Eigen::MatrixXf(mixture.mixing.rows(), count),
            Eigen::MatrixXf(count, mixture.mixing.rows()),
            Eigen::MatrixXf(mixture.sources.rows(), count),
            mixture.rotation.converged,
            mixture.rotation.iterations};
    for (Index d = 0; d < count; ++d) {
        const Index from = order[static_cast<std::size_t>(d)];
        const double sign = mixture.asymmetry(from) < 0 ? -1 : 1;
        out.mixing.col(d) = (sign * mixture.mixing.col(from)).cast<float>();
        out.unmixing.row(d) = (sign * mixture.unmixing.row(from)).cast<float>();
        out.sources.col(d) = (sign * mixture.sources.col(from)).cast<float>();
    }
    return out;
}

}  // namespace

Ica fit_ica(const Samples& samples, const IcaOptions& options) {
    check_ica_options(options);
    const Pca pca = fit_pca(samples, options.share, options.most);
    return in_order(rotate_sources(project_samples(pca, samples), options), pca.mean);
}

Ica fit_spatial_ica(const Samples& samples, const IcaOptions& options) {
    check_ica_options(options);
    const Pca pca = fit_pca(samples, options.share, options.most);
    return in_order(rotate_basis(project_samples(pca, samples), options), pca.mean);
}

}  // namespace exemplar
