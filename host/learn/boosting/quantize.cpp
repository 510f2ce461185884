#include "host/learn/boosting/quantize.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <string>

#include "host/core/errors.h"
#include "host/core/parallel.h"

namespace exemplar {
namespace {

/// A value as an unsigned integer of the same order, in the upper half; the lower half is left for an index.
std::uint64_t sort_key(float value) {
    const std::uint32_t bits = std::bit_cast<std::uint32_t>(value + 0.0f);  // + 0: negative zero sorts with zero
    return static_cast<std::uint64_t>(bits >> 31 ? ~bits : bits | 0x80000000u) << 32;
}

/// Sorts by the upper half of the keys: a radix sort with four passes of 8 bits, so that few places are written to
/// at once.
void sort_keys(std::vector<std::uint64_t>& keys) {
    std::array<std::array<std::size_t, 257>, 4> start{};
    for (const std::uint64_t key : keys) {
        for (std::size_t pass = 0; pass < 4; ++pass) ++start[pass][(key >> (32 + 8 * pass) & 255) + 1];
    }
    std::vector<std::uint64_t> other(keys.size());
    for (std::size_t pass = 0; pass < 4; ++pass) {
        for (std::size_t digit = 0; digit < 256; ++digit) start[pass][digit + 1] += start[pass][digit];
        for (const std::uint64_t key : keys) other[start[pass][key >> (32 + 8 * pass) & 255]++] = key;
        keys.swap(other);
    }
}

/// A distinct value and the weight of the rows that have it.
struct WeightedValue {
    float value;
    double weight;
};

std::vector<WeightedValue> distinct_values(std::span<const float> values, std::span<const float> weights) {
    std::vector<std::uint64_t> keys;
    keys.reserve(values.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (!std::isnan(values[i])) keys.push_back(sort_key(values[i]) | i);
    }
    sort_keys(keys);
    std::vector<WeightedValue> distinct;
    for (const std::uint64_t key : keys) {
        const std::size_t row = key & 0xffffffffu;
        if (distinct.empty() || distinct.back().value != values[row]) distinct.push_back({values[row], 0.0});
        distinct.back().weight += weights.empty() ? 1.0 : static_cast<double>(weights[row]);
    }
    return distinct;
}

/// A float t with low <= t < high, in the middle where possible, so that `x > t` tells the two apart.
float between(float low, float high) {
    const auto middle = static_cast<float>(0.5 * (static_cast<double>(low) + static_cast<double>(high)));
    return low <= middle && middle < high ? middle : low;
}

void check_bins(std::size_t bins) {
    if (bins < 2 || bins > k_max_bins) {
        throw UsageError("the number of bins is " + std::to_string(bins) + "; it must be 2 to " +
                         std::to_string(k_max_bins));
    }
}

/// The thresholds of a feature, padded with infinity, which no value exceeds. A branchless search with a fixed
/// number of steps lets the processor work on several values at once.
struct PaddedThresholds {
    std::array<float, k_max_bins> values;

    explicit PaddedThresholds(const std::vector<float>& thresholds) {
        values.fill(std::numeric_limits<float>::infinity());
        std::copy(thresholds.begin(), thresholds.end(), values.begin());
    }
    /// Number of thresholds below x.
    std::uint8_t bin_of(float x) const {
        std::uint32_t bin = 0;
        for (std::uint32_t bit = 8; bit-- > 0;) {
            bin |= static_cast<std::uint32_t>(x > values[bin + (1u << bit) - 1]) << bit;
        }
        return static_cast<std::uint8_t>(bin);
    }
};

void fill_bins(QuantizedFeatures& out, const FeatureMatrix& features, std::size_t feature) {
    const PaddedThresholds thresholds(out.thresholds[feature]);
    std::uint8_t* bins = out.bins.data() + feature * out.rows;
    const std::span<const float> values = features.column(feature);
    for (std::size_t i = 0; i < out.rows; ++i) bins[i] = thresholds.bin_of(values[i]);
}

/// Every k-th value, so that at most `limit` remain.
std::vector<float> every_kth(std::span<const float> values, std::size_t limit) {
    const std::size_t step = limit == 0 ? 1 : (values.size() + limit - 1) / limit;
    std::vector<float> sample;
    for (std::size_t i = 0; i < values.size(); i += std::max<std::size_t>(step, 1)) sample.push_back(values[i]);
    return sample;
}

}  // namespace

std::vector<float> quantile_thresholds(std::span<const float> values, std::span<const float> weights,
                                       std::size_t bins) {
    check_bins(bins);
    const std::vector<WeightedValue> distinct = distinct_values(values, weights);
    std::vector<float> thresholds;
    const bool keep_all = distinct.size() <= bins;
    double left = 0.0;
    for (const WeightedValue& item : distinct) left += item.weight;
    double in_bin = 0.0;
    for (std::size_t i = 0; i + 1 < distinct.size(); ++i) {
        in_bin += distinct[i].weight;
        const std::size_t bins_left = bins - thresholds.size();
        if (bins_left == 1) break;
        // The share is recomputed for each bin: if a frequent value fills one bin, the others are still divided
        // well.
        if (!keep_all && in_bin * static_cast<double>(bins_left) < left) continue;
        thresholds.push_back(between(distinct[i].value, distinct[i + 1].value));
        left -= in_bin;
        in_bin = 0.0;
    }
    return thresholds;
}

QuantizedFeatures quantize(const FeatureMatrix& features, std::span<const float> weights,
                           const QuantizeOptions& options) {
    check_bins(options.bins);
    if (!weights.empty() && weights.size() != features.rows) {
        throw UsageError("there are " + std::to_string(weights.size()) + " weights for " +
                         std::to_string(features.rows) + " rows; give one per row");
    }
    QuantizedFeatures out{features.rows, std::vector<std::vector<float>>(features.cols()),
                          std::vector<std::uint8_t>(features.rows * features.cols())};
    const std::vector<float> sample_weights = every_kth(weights, options.sample_rows);
    parallel_for(features.cols(), [&](std::size_t feature) {
        const std::span<const float> column = features.column(feature);
        out.thresholds[feature] =
            features.rows <= options.sample_rows
                ? quantile_thresholds(column, weights, options.bins)
                : quantile_thresholds(every_kth(column, options.sample_rows), sample_weights, options.bins);
        fill_bins(out, features, feature);
    });
    return out;
}

}  // namespace exemplar
