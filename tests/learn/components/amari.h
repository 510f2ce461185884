#pragma once

#include <Eigen/Core>

namespace exemplar {

/// How far `product` (recovered unmixing times true mixing) is from a permutation with signs and scales: 0 if it is
/// one, at most 1 (Amari et al. 1996, normalized).
inline double amari_index(const Eigen::MatrixXd& product) {
    const Eigen::MatrixXd p = product.cwiseAbs();
    const auto excess = [](const Eigen::MatrixXd& m) {
        return ((m.rowwise().sum().array() / m.rowwise().maxCoeff().array()) - 1).sum();
    };
    const double size = static_cast<double>(p.rows());
    return (excess(p) + excess(p.transpose())) / (2 * size * (size - 1));
}

}  // namespace exemplar
