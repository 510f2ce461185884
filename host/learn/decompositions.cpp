#include "host/learn/decompositions.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace exemplar {

Eigen::MatrixXd SymmetricEigen::inverse_sqrt() const {
    return vectors * values.cwiseInverse().cwiseSqrt().asDiagonal() * vectors.adjoint();
}

SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& matrix) {
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(matrix);
    return {solver.eigenvalues(), solver.eigenvectors()};
}

Eigen::VectorXd solve_ldlt(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right) {
    return matrix.ldlt().solve(right);
}

Eigen::MatrixXd solve_ldlt(const Eigen::MatrixXd& matrix, const Eigen::MatrixXd& right) {
    return matrix.ldlt().solve(right);
}

Eigen::MatrixXd solve_cholesky(Eigen::MatrixXd matrix, const Eigen::MatrixXd& right) {
    const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> in_place(matrix);
    return in_place.solve(right);
}

}  // namespace exemplar
