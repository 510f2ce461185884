#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "host/hatching/style/orientation_samples.h"

namespace exemplar {

/// A first guess at the regions of a drawing that follow one rule.
struct OrientationClusters {
    std::size_t count = 0;
    std::vector<std::uint32_t> cluster;  ///< of each sample, by falling size
    std::vector<std::uint8_t> second;    ///< of each sample: 1 if it follows the cluster's second direction
    std::vector<std::uint8_t> cross;     ///< of each cluster: 1 if it is cross-hatched
};

/// Constrained mean-shift clustering with a flat kernel (thesis Sec. 4.4.1, "Initialization"): clusters grow from
/// random seeds over neighbors whose direction differs from the mean direction of the cluster (of cross-hatching the
/// nearer of two) by less than a threshold, the median difference between neighbors, but no less than 15 degrees, lest
/// noise-free curved hatching fall into slivers. Beyond the thesis, single strokes and cross-hatching begin in clusters
/// of their own: grown together, two regions of single strokes would pass for the two directions of the cross-hatching
/// between them, and no later step parts them. More than 10% of cross-hatched pixels make a cluster cross-hatching;
/// the first of its directions is the one that single strokes follow, or, if all cross, the one with more pixels. At
/// most `most` clusters are kept; what belongs to none joins the one of its level whose direction fits best.
OrientationClusters grow_clusters(const OrientationSamples& samples, std::size_t most, std::uint64_t seed);

}  // namespace exemplar
