#include "host/learn/boosting/split_histograms.h"

#include <algorithm>
#include <array>

namespace exemplar {
namespace {

constexpr std::size_t k_histogram_chunk = 8192;
constexpr float k_tiny_sum = 1e-30f;

/// Adds the weights of `count` entries to the histograms of four features: bins x width each. Not inlined, so that
/// all of it stays in registers: this loop is most of the training time.
template <int width, bool indexed>
[[gnu::noinline]] void add_rows(const LaneFloats<width>* weights, const std::uint32_t* rows, std::size_t count,
                                const std::array<const std::uint8_t*, 4>& bins, float* histograms, std::size_t stride) {
    using Floats = LaneFloats<width>;
    auto* h0 = reinterpret_cast<Floats*>(histograms);
    auto* h1 = reinterpret_cast<Floats*>(histograms + stride);
    auto* h2 = reinterpret_cast<Floats*>(histograms + 2 * stride);
    auto* h3 = reinterpret_cast<Floats*>(histograms + 3 * stride);
    const auto [b0, b1, b2, b3] = bins;
    for (std::size_t i = 0; i < count; ++i) {
        const Floats value = weights[i];
        const std::size_t row = indexed ? rows[i] : i;
        h0[b0[row]] += value;
        h1[b1[row]] += value;
        h2[b2[row]] += value;
        h3[b3[row]] += value;
    }
}

/// Lanes of one panel.
template <int width>
LaneDoubles<width> load_lanes(const std::vector<double>& values, std::size_t panel) {
    LaneDoubles<width> out;
    for (int l = 0; l < width; ++l) out[l] = values[panel * width + static_cast<std::size_t>(l)];
    return out;
}

}  // namespace

RowSelection::RowSelection(const BoostingRows& rows, const SplitCandidate& split) {
    const std::uint8_t* bins = rows.column(split.feature);
    const auto count = static_cast<std::size_t>(
        std::count_if(bins, bins + rows.count, [&](std::uint8_t bin) { return bin > split.threshold; }));
    above_ = 2 * count < rows.count;
    row_.reserve(std::min(count, rows.count - count));
    for (const RowChunk& chunk : rows.chunks) {
        for (std::uint32_t row = chunk.begin; row < chunk.end; ++row) {
            if ((bins[row] > split.threshold) != above_) continue;
            const auto entry = static_cast<std::uint32_t>(row_.size());
            if (chunks_.empty() || chunks_.back().lane != chunk.lane ||
                entry - chunks_.back().begin == k_histogram_chunk) {
                chunks_.push_back({entry, entry, chunk.lane});
            }
            ++chunks_.back().end;
            row_.push_back(row);
        }
    }
    const std::size_t width = rows.layout.width;
    weights_.reserve(rows.layout.panels * row_.size() * width);
    for (std::size_t panel = 0; panel < rows.layout.panels; ++panel) {
        const float* weights = rows.panel(panel);
        for (const std::uint32_t row : row_) {
            weights_.insert(weights_.end(), weights + row * width, weights + (row + 1) * width);
        }
    }
}

SplitHistograms::SplitHistograms(const BoostingRows& rows, const QuantizedFeatures& features,
                                 std::span<const std::uint32_t> list)
    : rows_(&rows),
      features_(&features),
      list_(list.begin(), list.end()),
      groups_((list.size() + k_together - 1) / k_together) {
    for (std::size_t g = 0; g < groups_.size(); ++g) {
        for (std::size_t slot = 0; slot < k_together; ++slot) {
            groups_[g].bins = std::max(groups_[g].bins, features.thresholds[feature(g, slot)].size() + 1);
        }
        max_bins_ = std::max(max_bins_, groups_[g].bins);
    }
    clear();
}

std::uint32_t SplitHistograms::feature(std::size_t group, std::size_t slot) const {
    return list_[std::min(group * k_together + slot, list_.size() - 1)];
}

void SplitHistograms::clear() {
    for (Group& group : groups_) {
        group.own.assign(rows_->layout.padded() * k_together * group.bins, 0.0);
        group.other.assign(group.own.size(), 0.0);
    }
}

void SplitHistograms::add(const WeightedRows& added, const LaneFactors& factors) {
    AlignedFloats partial(k_together * max_bins_ * rows_->layout.width, 0.0f);
    with_width(rows_->layout, [&]<int width>() {
        for (std::size_t panel = 0; panel < rows_->layout.panels; ++panel) {
            for (const RowChunk& chunk : added.chunks) add_chunk<width>(added, chunk, panel, factors, partial);
        }
    });
}

template <int width>
void SplitHistograms::add_chunk(const WeightedRows& added, const RowChunk& chunk, std::size_t panel,
                                const LaneFactors& factors, AlignedFloats& partial) {
    const std::size_t entries = added.weights.size() / rows_->layout.padded();
    const auto* weights = reinterpret_cast<const LaneFloats<width>*>(added.weights.data()) + panel * entries;
    const bool indexed = !added.row.empty();
    for (std::size_t g = 0; g < groups_.size(); ++g) {
        std::array<const std::uint8_t*, k_together> columns;
        for (std::size_t slot = 0; slot < k_together; ++slot) {
            columns[slot] = rows_->column(feature(g, slot)) + (indexed ? 0 : chunk.begin);
        }
        const std::size_t count = chunk.end - chunk.begin, stride = groups_[g].bins * width;
        if (indexed) {
            add_rows<width, true>(weights + chunk.begin, added.row.data() + chunk.begin, count, columns, partial.data(),
                                  stride);
        } else {
            add_rows<width, false>(weights + chunk.begin, nullptr, count, columns, partial.data(), stride);
        }
        flush<width>(chunk, panel, factors, partial, groups_[g]);
    }
}

/// Moves the sums of one chunk into the totals. Two levels keep float sums accurate: a chunk is a few thousand rows.
template <int width>
void SplitHistograms::flush(const RowChunk& chunk, std::size_t panel, const LaneFactors& factors,
                            AlignedFloats& partial, Group& totals) {
    const std::size_t bins = totals.bins * k_together, offset = panel * bins * width;
    LaneDoubles<width> factor = load_lanes<width>(factors.other, panel);
    const auto own = static_cast<std::size_t>(chunk.lane) - panel * width;  // wraps beyond width for other panels
    if (chunk.lane != k_no_lane && own < width) {
        const double own_factor = factors.own[static_cast<std::size_t>(chunk.lane)];
        double* sums = totals.own.data() + offset + own;
        for (std::size_t b = 0; b < bins; ++b) {
            sums[b * width] += own_factor * static_cast<double>(partial[b * width + own]);
        }
        factor[own] = 0.0;
    }
    auto* from = reinterpret_cast<LaneFloats<width>*>(partial.data());
    auto* to = reinterpret_cast<LaneDoubles<width>*>(totals.other.data() + offset);
    for (std::size_t b = 0; b < bins; ++b) {
        to[b] += factor * __builtin_convertvector(from[b], LaneDoubles<width>);
        from[b] = LaneFloats<width>{};
    }
}

void SplitHistograms::update_after_split(const WeightedRows& few, const LaneFactors& small, const LaneFactors& large) {
    LaneFactors rest{large.own, large.other};  // of N: 1 - large / small
    for (std::size_t l = 0; l < rest.own.size(); ++l) {
        rest.own[l] = 1.0 - large.own[l] / small.own[l];
        rest.other[l] = 1.0 - large.other[l] / small.other[l];
    }
    scale(large);
    add(few, rest);
    forget_rounding();
}

void SplitHistograms::scale(const LaneFactors& factors) {
    with_width(rows_->layout, [&]<int width>() {
        for (Group& group : groups_) {
            auto* own = reinterpret_cast<LaneDoubles<width>*>(group.own.data());
            auto* other = reinterpret_cast<LaneDoubles<width>*>(group.other.data());
            for (std::size_t panel = 0; panel < rows_->layout.panels; ++panel) {
                const LaneDoubles<width> own_factor = load_lanes<width>(factors.own, panel);
                const LaneDoubles<width> other_factor = load_lanes<width>(factors.other, panel);
                for (std::size_t b = 0; b < k_together * group.bins; ++b)
                    *own++ *= own_factor, *other++ *= other_factor;
            }
        }
    });
}

/// Raises sums that rounding made negative to zero: with them, a split without weight would gain.
void SplitHistograms::forget_rounding() {
    for (Group& group : groups_) {
        for (AlignedDoubles* sums : {&group.own, &group.other}) {
            for (double& sum : *sums) sum = std::max(sum, 0.0);
        }
    }
}

void SplitHistograms::split_sums(std::size_t index, std::span<const std::uint32_t> candidates, SplitSums& out) const {
    const Group& group = groups_[index / k_together];
    const std::size_t thresholds = features_->thresholds[list_[index]].size(), width = rows_->layout.width;
    out.resize(candidates.size(), thresholds);
    for (std::size_t c = 0; c < candidates.size(); ++c) {
        const std::size_t first = candidates[c] / width * k_together + index % k_together;  // panel and slot
        const double* own = group.own.data() + first * group.bins * width + candidates[c] % width;
        const double* other = group.other.data() + first * group.bins * width + candidates[c] % width;
        double all_own = 0.0, all_other = 0.0;
        for (std::size_t b = 0; b <= thresholds; ++b) all_own += own[b * width], all_other += other[b * width];
        const double all_s = all_own - all_other, all_w = all_own + all_other;
        out.constant_gain[c] = static_cast<float>(all_s * all_s / (all_w + static_cast<double>(k_tiny_sum)));
        double below_own = 0.0, below_other = 0.0;
        for (std::size_t t = 0; t < thresholds; ++t) {
            below_own += own[t * width], below_other += other[t * width];
            const std::size_t at = c * out.stride + t;
            out.below_w[at] = static_cast<float>(below_own + below_other);
            out.below_s[at] = static_cast<float>(below_own - below_other);
            out.above_w[at] = static_cast<float>(all_w - (below_own + below_other));
            out.above_s[at] = static_cast<float>(all_s - (below_own - below_other));
        }
    }
}

}  // namespace exemplar
