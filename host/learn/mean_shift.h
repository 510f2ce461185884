#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace exemplar {

struct MeanShiftClusters {
    Eigen::MatrixXf modes;               ///< clusters x dimensions, the largest cluster first
    std::vector<std::uint32_t> cluster;  ///< of each point
};

/// Mean-shift clustering (Comaniciu and Meer 2002) of N x D points with a Gaussian kernel of standard deviation
/// `bandwidth`. At most `seeds` evenly chosen points define the density, and the search for modes starts from each
/// of them. Modes closer than the bandwidth are merged. Every point joins the nearest mode; modes with fewer than
/// `smallest` points are dissolved. No points give no clusters.
MeanShiftClusters mean_shift(const Eigen::Ref<const Eigen::MatrixXf>& points, float bandwidth, std::size_t smallest = 1,
                             std::size_t seeds = 1500);

}  // namespace exemplar
