#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "host/learn/feature_matrix.h"

namespace exemplar {

constexpr std::size_t k_max_bins = 256;

/// How feature values are sorted into bins.
struct QuantizeOptions {
    std::size_t bins = 128;             ///< at most this many bins per feature, 2 to k_max_bins
    std::size_t sample_rows = 200'000;  ///< with more rows, quantiles come from every k-th row
};

/// Feature values as bins, the form that boosting trains on. The bin of a value is the number of thresholds below it,
/// so `bin > t` holds exactly where `value > thresholds[feature][t]`; a NaN is in bin 0 (not above any threshold).
struct QuantizedFeatures {
    std::size_t rows = 0;
    std::vector<std::vector<float>> thresholds;  ///< per feature, rising; one less than the feature's bins
    std::vector<std::uint8_t> bins;              ///< features x rows, feature-major

    std::size_t cols() const { return thresholds.size(); }
    std::span<const std::uint8_t> column(std::size_t feature) const { return {bins.data() + feature * rows, rows}; }
};

/// Returns the thresholds of one feature: between every two neighboring distinct values if these fit into `bins`
/// bins, otherwise at weighted quantiles, so that bins have about equal weight. Each is a midpoint between two
/// values that occur (or the lower one, if no float lies between). NaNs are ignored. `weights`: one per value, not
/// negative; empty means equal.
std::vector<float> quantile_thresholds(std::span<const float> values, std::span<const float> weights, std::size_t bins);

/// Quantizes all features, in parallel. `weights`: one per row (e.g. its area); empty means equal.
/// Throws UsageError for bins out of range or weights of another size.
QuantizedFeatures quantize(const FeatureMatrix& features, std::span<const float> weights,
                           const QuantizeOptions& options);

}  // namespace exemplar
