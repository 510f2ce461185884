#pragma once

#include <cstdint>
#include <span>

#include "host/learn/boosting_rows.h"

namespace exemplar {

/// A split of one feature and the lanes that share it.
struct SplitCandidate {
    float gain = 0;  ///< how much Eq. 3.6 falls below that of constants k_c alone
    std::uint32_t feature = 0;
    std::uint32_t threshold = 0;  ///< index: "above" is bin > threshold
    std::uint64_t lanes = 0;      ///< bit l: lane l shares the split; zero if no split gains anything
};

/// Which subsets of lanes the search may share a split between.
struct SubsetSearch {
    std::span<const std::uint32_t> candidates;  ///< lanes that may share
    bool exhaustive = true;                     ///< all subsets, else greedily grown (Torralba et al. 2007)
};

/// The best split over `features` (thesis Eq. 3.6 with a, b, k_c in closed form), from the histograms of the weights of
/// the rows in `chunks`. Ties go to the lower feature, threshold and subset, so the result does not depend on threads.
SplitCandidate find_best_split(const BoostingRows& rows, std::span<const RowChunk> chunks,
                               const QuantizedFeatures& features, std::span<const std::uint32_t> feature_list,
                               const SubsetSearch& subsets);

}  // namespace exemplar
