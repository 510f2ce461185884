#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "host/learn/boosting/boosted_stumps.h"

namespace exemplar {

/// The thresholds that stumps compare one feature with.
struct FeatureThresholds {
    std::uint32_t feature;
    std::vector<float> thresholds;  ///< distinct, rising

    /// Returns the index of `threshold`, which must be one of them.
    std::uint32_t index_of(float threshold) const;
};

/// Returns the thresholds of each feature that a stump uses, by rising feature number. No threshold may be NaN.
std::vector<FeatureThresholds> thresholds_of(std::span<const Stump> stumps);

/// Computes the ranks of values: the number of `thresholds` (distinct, rising) below each. A rank answers every
/// stump: value > thresholds[i] holds exactly where rank > i, and NaN has rank 0. `ranks` has one entry per value;
/// thresholds.size() must fit its type. Ranks count from `lowest` and wrap around: with half of the type's range, they
/// are in order as signed numbers.
void rank(std::span<const float> values, std::span<const float> thresholds, std::span<std::uint8_t> ranks,
          std::uint8_t lowest = 0);
void rank(std::span<const float> values, std::span<const float> thresholds, std::span<std::uint16_t> ranks,
          std::uint16_t lowest = 0);

/// Returns, for each feature that one of several such lists has, the thresholds of all of them.
std::vector<FeatureThresholds> merged(std::span<const std::vector<FeatureThresholds>> lists);

}  // namespace exemplar
