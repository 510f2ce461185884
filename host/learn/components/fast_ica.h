#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>

#include "host/learn/components/pca.h"

namespace exemplar {

/// The contrast function G, whose mean over a component measures how far from Gaussian it is (Hyvarinen 1999).
enum class IcaContrast {
    log_cosh,  ///< log cosh u: for most data
    gauss,     ///< -exp(-u^2 / 2): for very heavy tails
    kurtosis,  ///< u^4 / 4 (Eq. 2.83): for light tails without outliers
};

enum class IcaScheme {
    symmetric,  ///< all components at once
    deflation,  ///< one after the other
};

struct IcaOptions {
    double share = 0.95;             ///< share of the variance that the components carry, in (0, 1]
    std::size_t most = k_unlimited;  ///< maximum number of components
    IcaContrast contrast = IcaContrast::log_cosh;
    IcaScheme scheme = IcaScheme::symmetric;
    std::uint64_t seed = 1;   ///< of the initial rotation
    int iterations = 200;     ///< maximum, per component under deflation
    double tolerance = 1e-5;  ///< a component has converged when the cosine of its change is this close to 1
};

/// Independent components (thesis Sec. 2.5.2): y = mixing z + mean (Eq. 5.7) for samples y with M values.
struct Ica {
    Eigen::VectorXf mean;      ///< M values
    Eigen::MatrixXf mixing;    ///< M x D: W of Eq. 5.7, its columns sorted by falling length
    Eigen::MatrixXf unmixing;  ///< D x M: z = unmixing (y - mean)
    Eigen::MatrixXf sources;   ///< N x D: z of the samples, of zero mean and unit variance
    bool converged = true;     ///< if not, the components are still a basis of the same subspace
    int iterations = 0;        ///< maximum over the components
};

/// FastICA (Hyvarinen 1999, the thesis' [56]) of `samples` (N x M, one sample per row). Whitens them to the
/// principal components that carry options.share of the variance, and rotates these to be least Gaussian, so that
/// the sources are as independent over the samples as possible. Sources are uncorrelated, and the third moment of
/// each is positive. If the fixed-point iteration oscillates, its steps are shortened; Gaussian data may not
/// converge. The same seed gives the same result on any number of threads. Samples that do not vary have no
/// components.
/// Throws what fit_pca throws, and UsageError for a tolerance or a number of iterations that is not above 0.
Ica fit_ica(const Eigen::Ref<const Eigen::MatrixXf>& samples, const IcaOptions& options = {});

/// Spatial FastICA, for local bases (thesis Fig. 2.6): rotates the orthonormal basis of the principal subspace so
/// that the columns of the mixing matrix are as independent over the M values as possible, which for local
/// deformations means sparse. The columns are orthogonal; the third moment of each over its entries is positive. The
/// sources are the projections of the samples, scaled to unit variance; unlike those of fit_ica they may correlate.
/// Otherwise like fit_ica.
Ica fit_spatial_ica(const Eigen::Ref<const Eigen::MatrixXf>& samples, const IcaOptions& options = {});

}  // namespace exemplar
