#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <vector>

#include "host/core/parallel.h"

namespace exemplar {

/// Computes A A^T in double (rows x rows, both triangles) for a matrix A of `columns` columns that is never stored
/// as a whole: `chunk(begin, end)` returns its columns [begin, end) as a MatrixXd. Runs on all cores; the columns
/// are always summed in the same order.
template <typename Chunk>
Eigen::MatrixXd gram_of_chunks(Eigen::Index rows, Eigen::Index columns, const Chunk& chunk) {
    constexpr Eigen::Index k_groups = 8, k_chunk = 512;
    if (rows == 0 || columns == 0) return Eigen::MatrixXd::Zero(rows, rows);
    std::vector<Eigen::MatrixXd> sums(k_groups);
    const Eigen::Index group_size = (columns + k_groups - 1) / k_groups;
    parallel_for(k_groups, [&](std::size_t g) {
        sums[g] = Eigen::MatrixXd::Zero(rows, rows);
        const Eigen::Index first = static_cast<Eigen::Index>(g) * group_size;
        const Eigen::Index last = std::min(columns, first + group_size);
        for (Eigen::Index begin = first; begin < last; begin += k_chunk) {
            const Eigen::MatrixXd part = chunk(begin, std::min(last, begin + k_chunk));
            sums[g].template selfadjointView<Eigen::Lower>().rankUpdate(part);
        }
    });
    for (std::size_t g = 1; g < sums.size(); ++g) sums[0] += sums[g];
    sums[0].template triangularView<Eigen::StrictlyUpper>() = sums[0].transpose();
    return sums[0];
}

}  // namespace exemplar
