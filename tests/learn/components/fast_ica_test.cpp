#include "host/learn/components/fast_ica.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "host/core/errors.h"
#include "host/core/parallel.h"
#include "host/core/random.h"
#include "tests/learn/components/amari.h"
#include "tests/learn/regression/normal_matrix.h"

namespace exemplar {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::MatrixXf;

/// Two columns with lighter tails than a Gaussian (uniform, sine) and two with heavier ones (Laplace, exponential),
/// each of zero mean and unit variance.
MatrixXd known_sources(Index samples, std::uint64_t seed) {
    Random random(seed);
    MatrixXd sources(samples, 4);
    for (Index i = 0; i < samples; ++i) {
        const double sign = random.uniform() < 0.5 ? -1 : 1;
        sources.row(i) << random.uniform(-1, 1), std::sin(0.37 * static_cast<double>(i)),
            sign * std::log(1 - random.uniform()), -std::log(1 - random.uniform());
    }
    sources.rowwise() -= sources.colwise().mean().eval();
    for (Index d = 0; d < 4; ++d) sources.col(d) /= std::sqrt(sources.col(d).array().square().mean());
    return sources;
}

struct Mixed {
    MatrixXd sources;  // N x 4
    MatrixXd mixing;   // M x 4
    MatrixXf samples;  // N x M
};

Mixed mix(Index samples, Index values, std::uint64_t seed) {
    Mixed out{known_sources(samples, seed), normal_matrix(values, 4, seed + 1), {}};
    out.samples = ((out.sources * out.mixing.transpose()).array() + 5.0).cast<float>();
    return out;
}

IcaOptions exact_options() {
    IcaOptions options;
    options.share = 1;
    options.most = 4;
    return options;
}

double recovery_error(const Ica& ica, const MatrixXd& mixing) {
    return amari_index(MatrixXd(ica.unmixing.cast<double>() * mixing));
}

/// Means of 0, covariance of the identity.
void expect_white(const MatrixXf& sources) {
    const MatrixXd z = sources.cast<double>();
    EXPECT_LT(z.colwise().mean().cwiseAbs().maxCoeff(), 1e-5);
    EXPECT_TRUE((z.transpose() * z / static_cast<double>(z.rows())).isIdentity(1e-5));
}

/// The part of `columns` that the columns of `basis` do not span.
double outside(const MatrixXf& columns, const MatrixXf& basis) {
    const MatrixXd b = basis.cast<double>(), c = columns.cast<double>();
    return (c - b * b.colPivHouseholderQr().solve(c)).norm() / c.norm();
}

using Variant = std::tuple<IcaContrast, IcaScheme>;
class IcaVariants : public testing::TestWithParam<Variant> {
  protected:
    IcaOptions options() const {
        IcaOptions out = exact_options();
        std::tie(out.contrast, out.scheme) = GetParam();
        return out;
    }
};

TEST_P(IcaVariants, RecoverKnownSources) {
    const Mixed data = mix(6000, 12, 1);
    const Ica ica = fit_ica(data.samples, options());
    EXPECT_TRUE(ica.converged);
    ASSERT_EQ(ica.mixing.cols(), 4);
    // Sample moments of the fourth order vary much more: the kurtosis is led by a few outliers (thesis Sec. 2.5.2).
    const double bound = std::get<0>(GetParam()) == IcaContrast::kurtosis ? 0.05 : 0.03;
    const double index = recovery_error(ica, data.mixing);
    RecordProperty("amari", std::to_string(index));
    EXPECT_LT(index, bound);
    EXPECT_GT(amari_index(MatrixXd(fit_pca(data.samples, 1, 4).basis.transpose().cast<double>() * data.mixing)), 0.2)
        << "the principal components alone must not pass";
}

TEST_P(IcaVariants, SourcesAreWhiteAndWhatTheUnmixingGives) {
    const Mixed data = mix(700, 30, 2);
    const Ica ica = fit_ica(data.samples, options());
    expect_white(ica.sources);
    const MatrixXf again = (data.samples.rowwise() - ica.mean.transpose()) * ica.unmixing.transpose();
    EXPECT_LT((again - ica.sources).cwiseAbs().maxCoeff(), 1e-4F);
    EXPECT_TRUE((ica.unmixing * ica.mixing).isIdentity(1e-4F));
}

INSTANTIATE_TEST_SUITE_P(Variants, IcaVariants,
                         testing::Combine(testing::Values(IcaContrast::log_cosh, IcaContrast::gauss,
                                                          IcaContrast::kurtosis),
                                          testing::Values(IcaScheme::symmetric, IcaScheme::deflation)));

TEST(FastIca, RecoversSourcesFromMoreValuesThanSamples) {
    const Mixed data = mix(900, 4000, 3);
    const Ica ica = fit_ica(data.samples, exact_options());
    EXPECT_LT(recovery_error(ica, data.mixing), 0.1);  // fewer samples estimate less well
    EXPECT_TRUE(ica.converged);
}

TEST(FastIca, ColumnsAreSortedAndThirdMomentsPositive) {
    const Ica ica = fit_ica(mix(800, 20, 4).samples, exact_options());
    for (Index d = 0; d < ica.mixing.cols(); ++d) {
        EXPECT_GE(ica.sources.col(d).array().cube().sum(), 0);
        EXPECT_LE(ica.mixing.col(d).norm(), ica.mixing.col(std::max<Index>(d - 1, 0)).norm());
    }
}

TEST(FastIca, SpansThePrincipalSubspaceOfTheShare) {
    const MatrixXd weights = normal_matrix(60, 20, 5) * Eigen::VectorXd::LinSpaced(20, 2, 0.1).asDiagonal();
    const MatrixXf data = (weights * normal_matrix(20, 500, 6)).cast<float>();
    for (const double share : {0.6, 0.95, 1.0}) {
        IcaOptions options;
        options.share = share;
        const Pca pca = fit_pca(data, share);
        for (const Ica& ica : {fit_ica(data, options), fit_spatial_ica(data, options)}) {
            ASSERT_EQ(ica.mixing.cols(), pca.basis.cols());
            EXPECT_LT(outside(ica.mixing, pca.basis), 1e-5);
            const MatrixXf restored = (ica.sources * ica.mixing.transpose()).rowwise() + ica.mean.transpose();
            EXPECT_LT((restored - pca.restore(pca.project(data))).norm(), 1e-5 * data.norm());
            EXPECT_LT((restored - data).norm(), (std::sqrt(1 - share) + 1e-5) * data.norm());
        }
    }
}

TEST(FastIca, TheSameSeedGivesTheSameBytesOnAnyThreads) {
    const Mixed data = mix(5000, 30, 8);
    const Ica many = fit_ica(data.samples, exact_options());
    const Ica spatial = fit_spatial_ica(data.samples.transpose(), exact_options());
    const ThreadLimit one_thread(1);
    EXPECT_EQ(fit_ica(data.samples, exact_options()).unmixing, many.unmixing);
    EXPECT_EQ(fit_spatial_ica(data.samples.transpose(), exact_options()).unmixing, spatial.unmixing);
}

TEST(FastIca, AnySeedFindsTheSameComponents) {
    const Mixed data = mix(3000, 10, 9);
    IcaOptions other = exact_options();
    other.seed = 77;
    const Ica one = fit_ica(data.samples, exact_options()), two = fit_ica(data.samples, other);
    EXPECT_LT((one.mixing - two.mixing).norm(), 0.02F * one.mixing.norm());
}

TEST(FastIca, GaussianDataGiveAValidRotationEvenIfNothingConverges) {
    const MatrixXf data = normal_matrix(80, 300, 10).cast<float>();
    for (const IcaScheme scheme : {IcaScheme::symmetric, IcaScheme::deflation}) {
        IcaOptions options;
        options.share = 0.9;
        options.scheme = scheme;
        options.iterations = 3;
        const Ica ica = fit_ica(data, options);
        EXPECT_FALSE(ica.converged);
        EXPECT_EQ(ica.iterations, 3);
        expect_white(ica.sources);
        const Pca pca = fit_pca(data, 0.9);
        const MatrixXf restored = (ica.sources * ica.mixing.transpose()).rowwise() + ica.mean.transpose();
        EXPECT_LT((restored - pca.restore(pca.project(data))).norm(), 1e-5 * data.norm());
    }
}

TEST(FastIca, WhitensDirectionsOfVeryDifferentStrength) {
    MatrixXd sources = known_sources(2000, 11);
    const MatrixXd strength = Eigen::Vector4d(1, 1e-1, 1e-2, 1e-3).asDiagonal();
    const MatrixXd axes = MatrixXd(normal_matrix(50, 4, 12).householderQr().householderQ()).leftCols(4);
    const Ica ica = fit_ica((sources * strength * axes.transpose()).cast<float>(), exact_options());
    expect_white(ica.sources);
    EXPECT_LT(recovery_error(ica, axes * strength), 0.05);
}

TEST(FastIca, SamplesThatDoNotVaryHaveNoComponents) {
    for (const Index samples : {1, 20}) {
        const MatrixXf data = MatrixXf::Constant(samples, 30, 0.7F);
        for (const Ica& ica : {fit_ica(data, {}), fit_spatial_ica(data, {})}) {
            EXPECT_EQ(ica.mixing.rows(), 30);
            EXPECT_EQ(ica.mixing.cols(), 0);
            EXPECT_EQ(ica.unmixing.cols(), 30);
            EXPECT_EQ(ica.sources.rows(), samples);
            EXPECT_TRUE(ica.converged);
            EXPECT_EQ(ica.mean, data.row(0).transpose());
        }
    }
}

TEST(FastIca, OneComponentNeedsNoRotation) {
    const MatrixXf data = (normal_matrix(50, 1, 13) * normal_matrix(1, 20, 14)).cast<float>();
    for (const IcaScheme scheme : {IcaScheme::symmetric, IcaScheme::deflation}) {
        IcaOptions options;
        options.scheme = scheme;
        const Ica ica = fit_ica(data, options);
        EXPECT_TRUE(ica.converged);
        EXPECT_EQ(ica.mixing.cols(), 1);
        expect_white(ica.sources);
    }
}

TEST(FastIca, RefusesWhatItCannotUse) {
    MatrixXf data = mix(50, 8, 15).samples;
    IcaOptions options;
    options.iterations = 0;
    EXPECT_THROW(fit_ica(data, options), UsageError);
    options = {};
    options.tolerance = 0;
    EXPECT_THROW(fit_spatial_ica(data, options), UsageError);
    options = {};
    options.share = 2;
    EXPECT_THROW(fit_ica(data, options), UsageError);
    data(0, 0) = std::numeric_limits<float>::infinity();
    EXPECT_THROW(fit_ica(data, {}), DataError);
}

/// Samples made of bumps at `count` places along a line of values, which rise and fall partly by themselves, partly
/// (the more the larger `together`) with all others.
struct Bumps {
    MatrixXd shapes;   // values x count
    MatrixXf samples;  // samples x values
};

Bumps make_bumps(Index samples, Index values, Index count, double together, std::uint64_t seed) {
    Bumps out{MatrixXd(values, count), {}};
    const double width = 0.25 * static_cast<double>(values) / static_cast<double>(count);
    for (Index c = 0; c < count; ++c) {
        const double center = (static_cast<double>(c) + 0.5) * static_cast<double>(values) / static_cast<double>(count);
        for (Index v = 0; v < values; ++v) {
            out.shapes(v, c) = std::exp(-0.5 * std::pow((static_cast<double>(v) - center) / width, 2));
        }
    }
    const MatrixXd shared = normal_matrix(samples, 3, seed + 1) * normal_matrix(3, count, seed + 2);
    const MatrixXd weights = normal_matrix(samples, count, seed) + together * shared;
    out.samples = (weights * out.shapes.transpose() + 0.02 * normal_matrix(samples, values, seed + 3)).cast<float>();
    return out;
}

/// Sum of magnitudes over length, averaged over columns, over its largest value: 1 if all entries are alike.
double spread(const MatrixXf& columns) {
    const Eigen::ArrayXf ratio =
        columns.colwise().lpNorm<1>().transpose().array() / columns.colwise().norm().transpose().array();
    return static_cast<double>(ratio.mean()) / std::sqrt(static_cast<double>(columns.rows()));
}

/// Share of a column's entries, on average, that hold 99 % of its squared length.
double entries_for_energy(const MatrixXf& columns) {
    double sum = 0;
    for (Index d = 0; d < columns.cols(); ++d) {
        Eigen::VectorXd squares = columns.col(d).cast<double>().array().square();
        std::sort(squares.begin(), squares.end(), std::greater<>());
        double energy = 0;
        for (Index v = 0; v < squares.size() && energy < 0.99 * squares.sum(); ++v, ++sum) energy += squares(v);
        EXPECT_GT(energy, 0);
    }
    return sum / static_cast<double>(columns.size());
}

struct Sparsity {
    double spread, entries;
};

Sparsity sparsity_of(const char* name, const MatrixXf& columns) {
    const Sparsity out{spread(columns), entries_for_energy(columns)};
    testing::Test::RecordProperty(name, std::to_string(out.spread) + " " + std::to_string(out.entries));
    return out;
}

TEST(SpatialIca, FindsSparserBasesThanPcaAndTemporalIca) {
    const MatrixXf samples = make_bumps(120, 1200, 12, 0.4, 16).samples;
    const Ica spatial = fit_spatial_ica(samples, {});
    EXPECT_TRUE(spatial.converged);
    const Sparsity local = sparsity_of("spatial", spatial.mixing);
    for (const Sparsity global : {sparsity_of("temporal", fit_ica(samples, {}).mixing),
                                  sparsity_of("principal", fit_pca(samples, 0.95).basis)}) {
        EXPECT_LT(local.spread, 0.7 * global.spread);
        EXPECT_LT(local.entries, 0.4 * global.entries);
    }
}

TEST(SpatialIca, FindsSparserBasesEvenWhereFewerDirectionsThanBumpsAreKept) {
    const MatrixXf samples = make_bumps(120, 1200, 12, 1.0, 16).samples;
    const Ica spatial = fit_spatial_ica(samples, {});
    EXPECT_LT(spatial.mixing.cols(), 12);
    const Sparsity local = sparsity_of("spatial", spatial.mixing);
    for (const Sparsity global : {sparsity_of("temporal", fit_ica(samples, {}).mixing),
                                  sparsity_of("principal", fit_pca(samples, 0.95).basis)}) {
        EXPECT_LT(local.spread, 0.9 * global.spread);
        EXPECT_LT(local.entries, 0.9 * global.entries);
    }
}

TEST(SpatialIca, FindsTheBumpsThemselves) {
    const Bumps bumps = make_bumps(120, 1200, 12, 1.0, 17);
    IcaOptions options;
    options.share = 1;
    options.most = 12;
    const Ica ica = fit_spatial_ica(bumps.samples, options);
    for (Index c = 0; c < 12; ++c) {
        const Eigen::VectorXd shape = bumps.shapes.col(c).normalized();
        const MatrixXd columns = ica.mixing.cast<double>().colwise().normalized();
        EXPECT_GT((shape.transpose() * columns).maxCoeff(), 0.95) << "bump " << c;  // positive: it points up
    }
}

TEST(SpatialIca, ColumnsAreOrthogonalAndSourcesOfUnitVariance) {
    const Bumps bumps = make_bumps(90, 700, 9, 1.0, 18);
    const Ica ica = fit_spatial_ica(bumps.samples, {});
    const MatrixXf columns = ica.mixing.colwise().normalized();
    EXPECT_TRUE((columns.transpose() * columns).isIdentity(1e-4F));
    const Eigen::RowVectorXf variance = ica.sources.array().square().colwise().mean();
    EXPECT_TRUE(variance.isOnes(1e-4F));
    EXPECT_LT(ica.sources.colwise().mean().cwiseAbs().maxCoeff(), 1e-5F);
    EXPECT_TRUE((ica.unmixing * ica.mixing).isIdentity(1e-4F));
    for (Index d = 1; d < columns.cols(); ++d) EXPECT_LE(ica.mixing.col(d).norm(), ica.mixing.col(d - 1).norm());
}

}  // namespace
}  // namespace exemplar
