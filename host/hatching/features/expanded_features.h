#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "host/hatching/features/powers.h"
#include "host/learn/boosting/boosted_stumps.h"
#include "host/learn/feature_matrix.h"

namespace exemplar {

/// Features with the powers that a stump can tell apart, and which expanded feature (see powers.h) each column is. x^2
/// and 1/x are there only where x changes its sign, and 1/x^2 never: else they split the rows as x or x^2 does.
struct StumpFeatures {
    FeatureMatrix matrix;
    std::vector<std::uint32_t> expanded;  ///< of each column
};
StumpFeatures stump_features(const FeatureMatrix& base);

/// The base features that stumps over expanded features use, by rising number.
std::vector<std::uint32_t> used_features(const BoostedStumps& classifier);

/// Columns named by stumps over expanded features, from a matrix that holds the base features `which`; the stumps are
/// renumbered to them. Throws UsageError if one is missing.
struct CompactStumps {
    BoostedStumps classifier;
    FeatureMatrix features;
};
CompactStumps compact_stumps(const BoostedStumps& classifier, std::span<const std::uint32_t> which,
                             const FeatureMatrix& base);

}  // namespace exemplar
