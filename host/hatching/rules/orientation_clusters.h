#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "host/hatching/rules/orientation_samples.h"

namespace exemplar {

/// Initial segmentation of a drawing into regions that follow one rule.
struct OrientationClusters {
    std::size_t count = 0;
    std::vector<std::uint32_t> cluster;  ///< per sample; clusters are numbered by decreasing size
    std::vector<std::uint8_t> second;    ///< per sample: 1 if it follows the cluster's second direction
    std::vector<std::uint8_t> cross;     ///< per cluster: 1 if it is cross-hatched
};

/// Clusters samples by constrained mean shift with a flat kernel (thesis Sec. 4.4.1, "Initialization"). A cluster
/// grows from a random seed over neighbors whose direction is within a threshold of its mean direction, or of the
/// nearer of two for cross-hatching: the median difference between neighbors, at least 15 degrees. Beyond the
/// thesis, single strokes and cross-hatching start in separate clusters. A cluster with more than 10% cross-hatched
/// samples is cross-hatched; its first direction is that of its single strokes, or the more frequent one if it has
/// none. At most `most` clusters are kept; other samples join the best-fitting cluster of their level.
OrientationClusters grow_clusters(const OrientationSamples& samples, std::size_t most, std::uint64_t seed);

}  // namespace exemplar
