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

/// A column of expanded features: a power (powers.h) of a column of base features.
struct ExpandedColumn {
    std::size_t base;
    std::size_t power;
};

/// A classifier whose stumps are numbered by the columns that they use.
struct CompactStumps {
    BoostedStumps classifier;
    std::vector<ExpandedColumn> columns;
};
/// `which`: the base feature of each column of the matrix that the columns refer to. Throws UsageError if one is
/// missing.
CompactStumps compact_stumps(const BoostedStumps& classifier, std::span<const std::uint32_t> which);
/// Computes these columns of rows [first, first + count) into `out`, without names.
void expand_columns(std::span<const ExpandedColumn> columns, const FeatureMatrix& base, std::size_t first,
                    std::size_t count, FeatureMatrix& out);

}  // namespace exemplar
