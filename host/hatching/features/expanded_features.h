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

/// Features and those of their powers that give a stump other splits. x^2 and 1/x are included only for features
/// that take both signs, 1/x^2 never: the others split the rows as x or x^2 does.
struct StumpFeatures {
    FeatureMatrix matrix;
    std::vector<std::uint32_t> expanded;  ///< per column: its number in the expanded set, see powers.h
};
StumpFeatures stump_features(const FeatureMatrix& base);

/// Returns the base features that stumps over expanded features use, in increasing order.
std::vector<std::uint32_t> used_features(const BoostedStumps& classifier);

/// A classifier, and only the columns that its stumps use; the stumps are renumbered to these columns.
/// compact_stumps() computes the columns from `base`, which holds the base features `which`. It throws UsageError if
/// one is missing.
struct CompactStumps {
    BoostedStumps classifier;
    FeatureMatrix features;
};
CompactStumps compact_stumps(const BoostedStumps& classifier, std::span<const std::uint32_t> which,
                             const FeatureMatrix& base);

}  // namespace exemplar
