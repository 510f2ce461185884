#pragma once

#include <Eigen/Core>

#include "host/learn/components/fast_ica.h"

namespace exemplar {

/// Result of FastICA's fixed-point iteration.
struct IcaRotation {
    Eigen::MatrixXd rows;  ///< D x D orthogonal: component d of a white sample w is rows.row(d) * w
    bool converged = true;
    int iterations = 0;
};

/// Finds the rotation that makes the components of `white` (samples x D, second moments = the identity) least
/// Gaussian: FastICA's fixed-point iteration with the contrast, scheme, seed, iterations and tolerance of the
/// options.
IcaRotation find_rotation(const Eigen::MatrixXd& white, const IcaOptions& options);

}  // namespace exemplar
