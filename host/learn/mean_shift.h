#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace exemplar {

struct MeanShiftClusters {
    Eigen::MatrixXf modes;               ///< clusters x dimensions, the fullest first
    std::vector<std::uint32_t> cluster;  ///< of each point
};

/// Mean-shift clustering (Comaniciu and Meer 2002) with a Gaussian kernel of standard deviation `bandwidth`. Modes are
/// sought from at most `seeds` of the points, evenly taken, among as many; all points then join the nearest mode.
/// Modes nearer than the bandwidth are one; those that fewer than `smallest` points join are dissolved.
/// points: N x D. No points give no clusters.
MeanShiftClusters mean_shift(const Eigen::Ref<const Eigen::MatrixXf>& points, float bandwidth, std::size_t smallest = 1,
                             std::size_t seeds = 1500);

}  // namespace exemplar
