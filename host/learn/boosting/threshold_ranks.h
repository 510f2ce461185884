#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "host/learn/boosting/boosted_stumps.h"

namespace exemplar {

/// What stumps compare a feature with.
struct FeatureThresholds {
    std::uint32_t feature;
    std::vector<float> thresholds;  ///< distinct, rising

    /// Which one of them this is; it is one.
    std::uint32_t index_of(float threshold) const;
};

/// Of each feature that a stump names, by rising number. Thresholds are numbers.
std::vector<FeatureThresholds> thresholds_of(std::span<const Stump> stumps);

/// Ranks of values: how many of `thresholds` (distinct, rising) lie below each. All that stumps ask of a value is in
/// it: value > thresholds[i] holds exactly where rank > i, of NaN nowhere. As many ranks as values; each is at most
/// thresholds.size(), which must fit.
void rank(std::span<const float> values, std::span<const float> thresholds, std::span<std::uint8_t> ranks);
void rank(std::span<const float> values, std::span<const float> thresholds, std::span<std::uint16_t> ranks);

}  // namespace exemplar
