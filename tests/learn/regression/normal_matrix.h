#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "host/core/random.h"

namespace exemplar {

/// Independent normal deviates.
inline Eigen::MatrixXd normal_matrix(Eigen::Index rows, Eigen::Index cols, std::uint64_t seed) {
    Random random(seed);
    return Eigen::MatrixXd::NullaryExpr(rows, cols, [&] { return random.normal(); });
}

}  // namespace exemplar
