#include "host/learn/components/pca.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <limits>

#include "host/core/errors.h"
#include "host/core/parallel.h"
#include "host/core/random.h"
#include "tests/learn/regression/normal_matrix.h"

namespace exemplar {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::MatrixXf;

/// N samples along a few directions of falling deviation (1, 1/2, 1/3 ..), around a mean that is not zero.
MatrixXf low_rank_samples(Index samples, Index values, Index rank, std::uint64_t seed) {
    MatrixXd weights = normal_matrix(samples, rank, seed);
    for (Index d = 0; d < rank; ++d) weights.col(d) /= static_cast<double>(d + 1);
    const MatrixXd data = weights * normal_matrix(rank, values, seed + 1);
    return (data.array() + 3.0).cast<float>();
}

/// Eigenvalues of the covariance matrix, falling.
Eigen::VectorXd covariance_spectrum(const MatrixXf& samples) {
    const MatrixXd data = samples.cast<double>();
    const MatrixXd centered = data.rowwise() - data.colwise().mean();
    const Eigen::JacobiSVD<MatrixXd> svd(centered);
    return svd.singularValues().array().square() / static_cast<double>(samples.rows());
}

class PcaOfShape : public testing::TestWithParam<std::pair<Index, Index>> {};

TEST_P(PcaOfShape, HasTheVariancesOfTheCovarianceMatrixAndAnOrthonormalBasis) {
    const auto [samples, values] = GetParam();
    const MatrixXf data = low_rank_samples(samples, values, 6, 1);
    const Pca pca = fit_pca(data, 1.0);
    const Eigen::VectorXd expected = covariance_spectrum(data);
    ASSERT_GE(pca.variance.size(), 6);
    EXPECT_TRUE(pca.variance.head(6).isApprox(expected.head(6), 1e-9));
    EXPECT_NEAR(pca.total_variance, expected.sum(), 1e-9 * expected.sum());
    const MatrixXf gram = pca.basis.transpose() * pca.basis;
    EXPECT_TRUE(gram.isIdentity(1e-5F));
    for (Index d = 0; d < pca.basis.cols(); ++d) {
        EXPECT_EQ(pca.basis.col(d).maxCoeff(), pca.basis.col(d).cwiseAbs().maxCoeff());
    }
}

TEST_P(PcaOfShape, ComponentsHaveTheVarianceOfTheirDirectionAndDoNotCorrelate) {
    const auto [samples, values] = GetParam();
    const MatrixXf data = low_rank_samples(samples, values, 4, 2);
    const Pca pca = fit_pca(data, 0.9999);
    const MatrixXd components = pca.project(data).cast<double>();
    const MatrixXd covariance = components.transpose() * components / static_cast<double>(samples);
    EXPECT_TRUE(covariance.isApprox(MatrixXd(pca.variance.asDiagonal()), 1e-4));
    EXPECT_NEAR(components.colwise().mean().cwiseAbs().maxCoeff(), 0, 1e-4);
}

TEST_P(PcaOfShape, RestoresSamplesExactlyForShareOne) {
    const auto [samples, values] = GetParam();
    const MatrixXf data = normal_matrix(samples, values, 3).cast<float>();
    const Pca pca = fit_pca(data, 1.0);
    EXPECT_EQ(pca.basis.cols(), std::min(samples - 1, values));
    EXPECT_LT((pca.restore(pca.project(data)) - data).cwiseAbs().maxCoeff(), 2e-5F);
}

INSTANTIATE_TEST_SUITE_P(Shapes, PcaOfShape,
                         testing::Values(std::pair<Index, Index>{30, 1500}, std::pair<Index, Index>{40, 40},
                                         std::pair<Index, Index>{1300, 25}));

TEST(Pca, KeepsAsManyComponentsAsTheShareNeeds) {
    const Eigen::Vector4d variance(6, 2, 1, 1);
    EXPECT_EQ(components_for_variance(variance, 10, 0.5), 1U);
    EXPECT_EQ(components_for_variance(variance, 10, 0.6), 1U);
    EXPECT_EQ(components_for_variance(variance, 10, 0.61), 2U);
    EXPECT_EQ(components_for_variance(variance, 10, 1.0), 4U);
    EXPECT_EQ(components_for_variance(variance, 20, 0.95), 4U);
    EXPECT_EQ(components_for_variance(variance, 0, 0.95), 0U);
    EXPECT_EQ(components_for_variance(Eigen::Vector4d(6, 2, 1e-30, 0), 8, 1.0), 3U);
    EXPECT_THROW(components_for_variance(variance, 10, 0.0), UsageError);
    EXPECT_THROW(components_for_variance(variance, 10, 1.01), UsageError);
    EXPECT_THROW(components_for_variance(variance, 10, std::numeric_limits<double>::quiet_NaN()), UsageError);
}

TEST(Pca, FindsAFewStrongDirectionsAmongManyValues) {
    const MatrixXf data = low_rank_samples(50, 3000, 3, 4);
    const Pca all = fit_pca(data, 1.0);
    EXPECT_GE(all.variance(2), 1e6 * (all.variance.size() > 3 ? all.variance(3) : 0));  // the rest is rounding to float
    const Pca pca = fit_pca(data, 0.95);
    EXPECT_EQ(static_cast<std::size_t>(pca.basis.cols()),
              components_for_variance(all.variance, all.total_variance, 0.95));
    EXPECT_TRUE(pca.basis.isApprox(all.basis.leftCols(pca.basis.cols()), 1e-5F));
    EXPECT_EQ(fit_pca(data, 1.0, 2).basis.cols(), 2);
    EXPECT_EQ(fit_pca(data, 1.0, 0).basis.cols(), 0);
}

TEST(Pca, WeakDirectionsStayOrthogonalToStrongOnes) {
    MatrixXd weights = normal_matrix(40, 3, 5);
    weights.col(1) *= 1e-3;
    weights.col(2) *= 1e-5;
    MatrixXd directions = MatrixXd::Zero(3, 500);  // apart, so that rounding to float is as weak as the direction is
    for (Index d = 0; d < 3; ++d) directions.block(d, 100 * d, 1, 100) = normal_matrix(1, 100, 6 + d);
    const Pca pca = fit_pca((weights * directions).cast<float>(), 1.0);
    ASSERT_GE(pca.basis.cols(), 3);
    const MatrixXd basis = pca.basis.leftCols(3).cast<double>();
    EXPECT_TRUE((basis.transpose() * basis).isIdentity(1e-6));
    EXPECT_GT(std::abs(basis.col(2).segment(200, 100).norm()), 0.9999);
}

TEST(Pca, SamplesThatDoNotVaryHaveNoComponents) {
    for (const Index samples : {1, 7, 300}) {
        MatrixXf data(samples, 60);
        data.rowwise() = normal_matrix(1, 60, 7).cast<float>().row(0) * 1e4F;
        const Pca pca = fit_pca(data, 1.0);
        EXPECT_EQ(pca.basis.rows(), 60);
        EXPECT_EQ(pca.basis.cols(), 0) << samples << " samples";
        EXPECT_EQ(pca.project(data).cols(), 0);
        EXPECT_EQ(pca.restore(pca.project(data)), data);
    }
}

TEST(Pca, SamplesWithoutValuesAreFine) {
    const Pca pca = fit_pca(MatrixXf(5, 0), 0.95);
    EXPECT_EQ(pca.basis.cols(), 0);
    EXPECT_EQ(pca.restore(pca.project(MatrixXf(5, 0))).rows(), 5);
}

TEST(Pca, DoesNotDependOnThreads) {
    const MatrixXf data = low_rank_samples(60, 5000, 20, 8);
    const Pca many = fit_pca(data, 1.0);
    const ThreadLimit one_thread(1);
    const Pca one = fit_pca(data, 1.0);
    EXPECT_EQ(many.basis, one.basis);
    EXPECT_EQ(many.variance, one.variance);
}

TEST(Pca, RefusesWhatItCannotUse) {
    MatrixXf data = low_rank_samples(5, 9, 2, 9);
    EXPECT_THROW(fit_pca(MatrixXf(0, 9), 0.95), UsageError);
    EXPECT_THROW(fit_pca(data, 0.0), UsageError);
    const Pca pca = fit_pca(data, 0.95);
    EXPECT_THROW(pca.project(MatrixXf::Zero(2, 8)), UsageError);
    EXPECT_THROW(pca.restore(MatrixXf::Zero(2, pca.basis.cols() + 1)), UsageError);
    data(3, 4) = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THROW(fit_pca(data, 0.95), DataError);
}

}  // namespace
}  // namespace exemplar
