#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "host/learn/boosting/boosting_rows.h"
#include "host/learn/boosting/boosting_weights.h"
#include "host/learn/boosting/split_histograms.h"

namespace exemplar {

/// Which subsets of lanes the search may share a split between.
struct SubsetSearch {
    std::vector<std::uint32_t> candidates;  ///< lanes that may share
    bool exhaustive = true;                 ///< all subsets, else greedily grown (Torralba et al. 2007)
};

/// Finds best splits (thesis Eq. 3.6 with a, b, k_c in closed form) from histograms of the rows' weights. Ties go to
/// the lower feature, threshold and subset, so the result does not depend on threads.
class StumpSearch {
  public:
    /// Keeps references to the data, and searches the features that have a threshold. Where every round reads all rows
    /// and features (`carry`), it keeps the histograms: after a split only the rows of its smaller side are read, as
    /// the weights of all others change by one factor per lane. Every few rounds they are made anew, so that rounding
    /// does not build up.
    StumpSearch(const BoostingRows& rows, const QuantizedFeatures& features, SubsetSearch subsets, bool carry);

    const std::vector<std::uint32_t>& features() const { return usable_; }
    /// The best split over all features and rows.
    SplitCandidate best();
    /// The best split over the features of `list`.
    SplitCandidate best(std::span<const std::uint32_t> list) const;
    /// The weights of the rows changed by `factors`, by this split.
    void weights_changed(const SplitCandidate& split, const WeightFactors& factors);

  private:
    SplitCandidate best_of(const SplitHistograms& histograms) const;
    WeightedRows all_rows() const;
    void refresh(SplitHistograms& histograms, const RowSelection* selection) const;

    const BoostingRows& rows_;
    const QuantizedFeatures& features_;
    SubsetSearch subsets_;
    std::vector<std::uint32_t> usable_;
    bool carry_;
    LaneFactors ones_;
    std::vector<SplitHistograms> kept_;
    std::size_t carried_ = 0;  // rounds since the histograms were made anew
    SplitCandidate last_split_;
    WeightFactors last_factors_;
};

}  // namespace exemplar
