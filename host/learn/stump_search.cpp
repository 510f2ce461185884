#include "host/learn/stump_search.h"

#include <algorithm>
#include <array>

#include "host/core/parallel.h"
#include "host/learn/subset_search.h"

namespace exemplar {
namespace {

constexpr std::size_t k_together = 4;     // features whose histograms share the first-level cache and hide latencies
constexpr std::size_t k_task_groups = 4;  // groups of features that read a chunk's weights while it is in cache
constexpr std::size_t k_task_features = k_together * k_task_groups;

constexpr float k_tiny = 1e-30f;

/// Adds the weights of `count` rows to the histograms of four features: bins x width each. Not inlined, because here
/// all must stay in registers: this loop is nearly all of the training time.
template <int width>
[[gnu::noinline]] void add_rows(const float* weights, std::size_t count,
                                const std::array<const std::uint8_t*, k_together>& bins, float* histograms,
                                std::size_t stride) {
    using Floats = LaneFloats<width>;
    const auto* w = reinterpret_cast<const Floats*>(weights);
    auto* h0 = reinterpret_cast<Floats*>(histograms);
    auto* h1 = reinterpret_cast<Floats*>(histograms + stride);
    auto* h2 = reinterpret_cast<Floats*>(histograms + 2 * stride);
    auto* h3 = reinterpret_cast<Floats*>(histograms + 3 * stride);
    const auto [b0, b1, b2, b3] = bins;
    for (std::size_t i = 0; i < count; ++i) {
        const Floats value = w[i];
        h0[b0[i]] += value;
        h1[b1[i]] += value;
        h2[b2[i]] += value;
        h3[b3[i]] += value;
    }
}

/// Histograms of four features over all chunks.
struct GroupHistograms {
    std::size_t bins = 0;    ///< most bins of the four
    AlignedFloats weight;    ///< panels x four x bins x width: W
    AlignedFloats positive;  ///< panels x four x bins x width: W of the rows whose own lane it is

    void reset(const LaneLayout& layout, std::size_t bin_count) {
        bins = bin_count;
        weight.assign(layout.padded() * k_together * bins, 0.0f);
        positive.assign(weight.size(), 0.0f);
    }
};

/// Moves the sums of one chunk into the totals. Two levels keep float sums accurate: a chunk is a few thousand rows.
template <int width>
void flush(const RowChunk& chunk, std::size_t panel, AlignedFloats& partial, GroupHistograms& totals) {
    const std::size_t bins = totals.bins * k_together;
    const std::size_t offset = panel * bins * width;
    auto* from = reinterpret_cast<LaneFloats<width>*>(partial.data());
    auto* to = reinterpret_cast<LaneFloats<width>*>(totals.weight.data() + offset);
    const auto own = static_cast<std::size_t>(chunk.lane) - panel * width;  // wraps beyond width for other panels
    if (chunk.lane != k_no_lane && own < width) {
        float* positive = totals.positive.data() + offset + own;
        for (std::size_t b = 0; b < bins; ++b) positive[b * width] += chunk.scale * partial[b * width + own];
    }
    for (std::size_t b = 0; b < bins; ++b) {
        to[b] += chunk.scale * from[b];
        from[b] = LaneFloats<width>{};
    }
}

/// Prefix sums of one feature's histogram as the sums of its splits.
void make_split_sums(const GroupHistograms& group, std::size_t slot, const LaneLayout& layout,
                     std::span<const std::uint32_t> candidates, std::size_t thresholds, SplitSums& out) {
    out.resize(candidates.size(), thresholds);
    for (std::size_t c = 0; c < candidates.size(); ++c) {
        const std::size_t panel = candidates[c] / layout.width;
        const std::size_t start =
            (panel * k_together + slot) * group.bins * layout.width + candidates[c] % layout.width;
        const float* w = group.weight.data() + start;
        const float* p = group.positive.data() + start;
        double total_w = 0.0, total_p = 0.0;
        for (std::size_t b = 0; b <= thresholds; ++b) total_w += w[b * layout.width], total_p += p[b * layout.width];
        const double total_s = 2.0 * total_p - total_w;
        out.constant_gain[c] = static_cast<float>(total_s * total_s / (total_w + static_cast<double>(k_tiny)));
        double below_w = 0.0, below_p = 0.0;
        for (std::size_t t = 0; t < thresholds; ++t) {
            below_w += w[t * layout.width];
            below_p += p[t * layout.width];
            const double below_s = 2.0 * below_p - below_w;
            const std::size_t at = c * out.stride + t;
            out.below_w[at] = static_cast<float>(below_w);
            out.below_s[at] = static_cast<float>(below_s);
            out.above_w[at] = static_cast<float>(total_w - below_w);
            out.above_s[at] = static_cast<float>(total_s - below_s);
        }
    }
}

/// The work of one task: a few groups of features, each with its histograms.
class SplitTask {
  public:
    SplitTask(const BoostingRows& rows, const QuantizedFeatures& features, std::span<const std::uint32_t> list)
        : rows_(rows), features_(features), list_(list), groups_((list.size() + k_together - 1) / k_together) {}

    void accumulate(std::span<const RowChunk> chunks) {
        std::vector<GroupHistograms> histograms(groups_);
        std::size_t most_bins = 0;
        for (std::size_t g = 0; g < groups_; ++g) {
            std::size_t bins = 0;
            for (std::size_t slot = 0; slot < k_together; ++slot) bins = std::max(bins, bins_of(feature(g, slot)));
            histograms[g].reset(rows_.layout, bins);
            most_bins = std::max(most_bins, bins);
        }
        AlignedFloats partial(k_together * most_bins * rows_.layout.width, 0.0f);
        with_width(rows_.layout, [&]<int width>() {
            for (std::size_t panel = 0; panel < rows_.layout.panels; ++panel) {
                for (const RowChunk& chunk : chunks) {
                    for (std::size_t g = 0; g < groups_; ++g) {
                        add_chunk<width>(chunk, panel, g, histograms[g].bins, partial);
                        flush<width>(chunk, panel, partial, histograms[g]);
                    }
                }
            }
        });
        histograms_ = std::move(histograms);
    }

    SplitCandidate best(const SubsetSearch& subsets) {
        SplitCandidate best;
        SplitSums sums;
        for (std::size_t i = 0; i < list_.size(); ++i) {
            const std::size_t thresholds = features_.thresholds[list_[i]].size();
            make_split_sums(histograms_[i / k_together], i % k_together, rows_.layout, subsets.candidates, thresholds,
                            sums);
            const SubsetChoice choice = subsets.exhaustive ? best_subset_exhaustive(sums) : best_subset_greedy(sums);
            if (choice.gain <= best.gain) continue;
            best = {choice.gain, list_[i], choice.threshold, 0};
            for (std::size_t c = 0; c < subsets.candidates.size(); ++c) {
                if (choice.subset >> c & 1) best.lanes |= std::uint64_t{1} << subsets.candidates[c];
            }
        }
        return best;
    }

  private:
    /// The last group repeats the last feature; what that adds up is not read.
    std::uint32_t feature(std::size_t group, std::size_t slot) const {
        return list_[std::min(group * k_together + slot, list_.size() - 1)];
    }
    std::size_t bins_of(std::size_t feature) const { return features_.thresholds[feature].size() + 1; }

    template <int width>
    void add_chunk(const RowChunk& chunk, std::size_t panel, std::size_t group, std::size_t bins,
                   AlignedFloats& partial) const {
        std::array<const std::uint8_t*, k_together> columns;
        for (std::size_t slot = 0; slot < k_together; ++slot) {
            columns[slot] = rows_.column(feature(group, slot)) + chunk.begin;
        }
        add_rows<width>(rows_.panel(panel) + static_cast<std::size_t>(chunk.begin) * width, chunk.end - chunk.begin,
                        columns, partial.data(), bins * width);
    }

    const BoostingRows& rows_;
    const QuantizedFeatures& features_;
    std::span<const std::uint32_t> list_;
    std::size_t groups_;
    std::vector<GroupHistograms> histograms_;
};

}  // namespace

SplitCandidate find_best_split(const BoostingRows& rows, std::span<const RowChunk> chunks,
                               const QuantizedFeatures& features, std::span<const std::uint32_t> feature_list,
                               const SubsetSearch& subsets) {
    std::vector<SplitCandidate> of_task((feature_list.size() + k_task_features - 1) / k_task_features);
    parallel_for(of_task.size(), [&](std::size_t t) {
        const std::size_t begin = t * k_task_features;
        SplitTask task(rows, features,
                       feature_list.subspan(begin, std::min(k_task_features, feature_list.size() - begin)));
        task.accumulate(chunks);
        of_task[t] = task.best(subsets);
    });
    SplitCandidate best;
    for (const SplitCandidate& candidate : of_task) {
        if (candidate.gain > best.gain) best = candidate;
    }
    return best;
}

}  // namespace exemplar
