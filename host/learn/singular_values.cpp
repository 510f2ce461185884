#include <Eigen/SVD>

#include "host/learn/decompositions.h"

namespace exemplar {

SingularValues singular_values(const Eigen::MatrixXd& matrix) {
    const Eigen::BDCSVD<Eigen::MatrixXd> svd(matrix, Eigen::ComputeThinU | Eigen::ComputeThinV);
    return {svd.matrixU(), svd.singularValues(), svd.matrixV()};
}

}  // namespace exemplar
