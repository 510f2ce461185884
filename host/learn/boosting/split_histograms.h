#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "host/learn/boosting/boosting_rows.h"
#include "host/learn/boosting/boosting_weights.h"
#include "host/learn/boosting/subset_search.h"

namespace exemplar {

/// Rows whose weights are summed: all rows in order, or chosen ones with copies of their weights.
struct WeightedRows {
    std::span<const std::uint32_t> row;  ///< row of each entry; empty: entry i is row i
    std::span<const float> weights;      ///< panels x entries x width
    std::span<const RowChunk> chunks;    ///< runs of entries
};

/// The rows of one side of a split, with copies of their weights.
class RowSelection {
  public:
    /// Selects the side of `split` with fewer rows.
    RowSelection(const BoostingRows& rows, const SplitCandidate& split);

    bool is_above() const { return above_; }
    WeightedRows view() const { return {row_, weights_, chunks_}; }

  private:
    bool above_ = false;
    std::vector<std::uint32_t> row_;
    AlignedFloats weights_;
    std::vector<RowChunk> chunks_;
};

/// Histograms of the weights for a few features: per bin and lane, the sum over the rows of the lane's class (own),
/// and the sum over all others (other).
class SplitHistograms {
  public:
    static constexpr std::size_t k_features = 16;  ///< maximum; their bins are read while the weights are in cache

    SplitHistograms(const BoostingRows& rows, const QuantizedFeatures& features, std::span<const std::uint32_t> list);

    void clear();
    /// Adds the weights of `added`, multiplied by the factors.
    void add(const WeightedRows& added, const LaneFactors& factors);
    /// Updates the sums after a change of weights. Most rows were multiplied by `large`, `few` rows, which hold
    /// their new weights, by `small`. With N the new sum of the few, the old sum H becomes (H - N / small) large +
    /// N.
    void update_after_split(const WeightedRows& few, const LaneFactors& small, const LaneFactors& large);

    std::span<const std::uint32_t> features() const { return list_; }
    /// Computes the sums of the splits of feature number `index` of the list, for these lanes.
    void split_sums(std::size_t index, std::span<const std::uint32_t> candidates, SplitSums& out) const;

  private:
    static constexpr std::size_t k_together = 4;  // features that share the first-level cache and hide latencies

    /// Sums of four features: panels x four x bins x width.
    struct Group {
        std::size_t bins = 0;  ///< maximum bins of the four
        AlignedDoubles own, other;
    };

    /// Returns the feature in a slot. The last group is filled up with the last feature, whose extra sums are not
    /// read.
    std::uint32_t feature(std::size_t group, std::size_t slot) const;
    template <int width>
    void add_chunk(const WeightedRows& added, const RowChunk& chunk, std::size_t panel, const LaneFactors& factors,
                   AlignedFloats& partial);
    template <int width>
    static void flush(const RowChunk& chunk, std::size_t panel, const LaneFactors& factors, AlignedFloats& partial,
                      Group& totals);
    void scale(const LaneFactors& factors);
    void forget_rounding();

    const BoostingRows* rows_;
    const QuantizedFeatures* features_;
    std::vector<std::uint32_t> list_;
    std::vector<Group> groups_;
    std::size_t max_bins_ = 0;
};

}  // namespace exemplar
