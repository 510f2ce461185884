#pragma once

#include <Eigen/Core>

/// Decompositions of matrices of any size. Eigen makes them from templates that take up to half a minute to compile, so
/// each is compiled once, here. Small matrices of fixed size are cheap: use Eigen's classes for those.
namespace exemplar {

/// A = V diag(values) V^T.
struct SymmetricEigen {
    Eigen::VectorXd values;   ///< ascending
    Eigen::MatrixXd vectors;  ///< a unit vector per column
    /// Returns V diag(1 / sqrt(values)) V^T; all values must be positive.
    Eigen::MatrixXd inverse_sqrt() const;
};
/// Decomposes a symmetric matrix, of which only the lower triangle is read.
SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& matrix);

/// A = U diag(values) V^T, for A of n x m: U is n x k, V is m x k, k = min(n, m).
struct SingularValues {
    Eigen::MatrixXd u;
    Eigen::VectorXd values;  ///< descending
    Eigen::MatrixXd v;
};
SingularValues singular_values(const Eigen::MatrixXd& matrix);

/// Solves A x = right for a symmetric, positive or negative semidefinite A (L D L^T, with pivoting).
Eigen::VectorXd solve_ldlt(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right);
Eigen::MatrixXd solve_ldlt(const Eigen::MatrixXd& matrix, const Eigen::MatrixXd& right);
/// Solves A X = right for a symmetric positive definite A (Cholesky); decomposes `matrix` in place.
Eigen::MatrixXd solve_cholesky(Eigen::MatrixXd matrix, const Eigen::MatrixXd& right);

}  // namespace exemplar
