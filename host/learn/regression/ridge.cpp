#include "host/learn/regression/ridge.h"

#include <utility>

#include "host/learn/decompositions.h"

namespace exemplar {

/// With D inputs, the dual form has an equation per row,
///
///     (Z Z^T / D + ridge diag(1 / w)) A = Y,   W = A^T Z / D
///
/// and the primal form one per input,
///
///     (Z^T diag(w) Z / D + ridge 1) W^T = Z^T diag(w) Y / D
///
/// The smaller of the two is solved.
RowMajorMatrix ridge_regression(const RowMajorMatrix& z, const Eigen::VectorXd& weight, const Eigen::MatrixXd& target,
                                double ridge) {
    const auto inputs = static_cast<double>(z.cols());
    if (z.rows() <= z.cols()) {
        Eigen::MatrixXd kernel = z * z.transpose() / inputs;
        kernel.diagonal() += ridge * weight.cwiseInverse();
        return solve_cholesky(std::move(kernel), target).transpose() * z / inputs;
    }
    const RowMajorMatrix weighted = weight.asDiagonal() * z;
    Eigen::MatrixXd normal = weighted.transpose() * z / inputs;
    normal.diagonal().array() += ridge;
    return solve_cholesky(std::move(normal), weighted.transpose() * target / inputs).transpose();
}

}  // namespace exemplar
