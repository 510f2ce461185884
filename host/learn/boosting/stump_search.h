#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "host/learn/boosting/boosting_rows.h"
#include "host/learn/boosting/boosting_weights.h"
#include "host/learn/boosting/split_histograms.h"

namespace exemplar {

/// Subsets of lanes that the search may share a split between.
struct SubsetOptions {
    std::vector<std::uint32_t> candidates;  ///< lanes that may share
    bool exhaustive = true;                 ///< all subsets, else greedily grown (Torralba et al. 2007)
};

/// Finds best splits (thesis Eq. 3.6 with a, b, k_c in closed form) from histograms of the rows' weights. Ties go to
/// the lower feature, threshold and subset, so the result does not depend on threads.
class StumpSearch {
  public:
    /// Keeps references to the data. Searches the features that have a threshold. With `carry`, for when every round
    /// reads all rows and features, it keeps the histograms: after a split it reads only the rows of the smaller
    /// side, as the weights of all others change by one factor per lane. It rebuilds them every few rounds, so that
    /// rounding does not build up.
    StumpSearch(const BoostingRows& rows, const QuantizedFeatures& features, SubsetOptions subsets, bool carry);

    const std::vector<std::uint32_t>& features() const { return usable_; }
    /// Returns the best split over all features and rows.
    SplitCandidate best();
    /// Returns the best split over the features of `list`.
    SplitCandidate best(std::span<const std::uint32_t> list) const;
    /// Notes that the weights of the rows have changed by `factors`, on the sides of `split`.
    void weights_changed(const SplitCandidate& split, const WeightFactors& factors);

  private:
    SplitCandidate best_of(const SplitHistograms& histograms) const;
    WeightedRows all_rows() const;
    void refresh(SplitHistograms& histograms, const RowSelection* selection) const;

    const BoostingRows& rows_;
    const QuantizedFeatures& features_;
    SubsetOptions subsets_;
    std::vector<std::uint32_t> usable_;
    bool incremental_;
    LaneFactors ones_;
    std::vector<SplitHistograms> kept_;
    std::size_t rounds_since_rebuild_ = 0;  // rounds since the histograms were rebuilt
    SplitCandidate last_split_;
    WeightFactors last_factors_;
};

}  // namespace exemplar
