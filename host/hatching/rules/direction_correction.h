#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "host/hatching/features/orientation_fields.h"
#include "host/learn/boosting/quantize.h"
#include "host/learn/feature_matrix.h"

namespace exemplar {

/// The fields that corrections are expressed in. They are smooth and defined nearly everywhere: the picture's x axis,
/// "k_max,3", "LxN", "e_b,3" and "grad V.N,4". With each, the field rotated by 45 degrees: the four multiples of 45
/// degrees, by weights of either sign, span all directions.
constexpr std::size_t k_direction_frames = 5;
constexpr std::size_t k_direction_parts = 2 * k_direction_frames;

/// Returns part 2 k (or 2 k + 1: rotated by 45 degrees) of an item, from field k of the list above.
DoubledAngle direction_part(const OrientationFields& fields, std::size_t part, std::size_t item);

/// Adds `above` times a part where a feature is above a threshold, `below` times elsewhere.
struct DirectionStump {
    std::uint32_t feature = 0;  ///< base feature of the pixel (not expanded)
    float threshold = 0;
    std::uint32_t part = 0;
    float below = 0, above = 0;
    bool operator==(const DirectionStump&) const = default;
};

/// Corrects the directions of rules (thesis Eq. 4.7) by fields whose weights vary with the features: the direction is
/// that of f = rule_weight v + sum of stumps, where v is the rule's direction. A hand follows a rule in places; a
/// weight for each segment cannot say where it departs from it.
struct DirectionCorrection {
    std::vector<float> rule_weight;  ///< per segment, in [0, 1]; empty: there is no correction
    std::vector<DirectionStump> stumps;

    bool empty() const { return rule_weight.empty(); }
    bool operator==(const DirectionCorrection&) const = default;
};

/// Returns the corrected directions of the rows of `fields`, normalized; zero where nothing gives one. `rules`: the
/// directions of the rules. `which`: the base feature of each column of `features`. Throws UsageError if a stump needs
/// a feature that is not there.
std::vector<DoubledAngle> corrected_directions(const DirectionCorrection& correction,
                                               std::span<const DoubledAngle> rules,
                                               std::span<const std::int32_t> segment, const OrientationFields& fields,
                                               std::span<const std::uint32_t> which, const FeatureMatrix& features);

/// Sets the directions of crossing hatches that no rule gives: at right angles to those of the hatches that they cross.
void cross_at_right_angles(std::span<const DoubledAngle> hatches, std::span<DoubledAngle> crossing);

/// Input of learn_correction(): strokes' pixels.
struct CorrectionTraining {
    const QuantizedFeatures& features;  ///< all base features; those without thresholds are not used
    const OrientationFields& fields;
    std::span<const DoubledAngle> target;  ///< direction of the stroke
    std::span<const DoubledAngle> rules;   ///< direction of the rule; zero where there is none
    std::span<const std::int32_t> segment;
    std::size_t segments;
    std::span<const std::uint8_t> held_out;  ///< 1: tells when to stop
    std::uint64_t seed;
};

struct LearnedCorrection {
    DirectionCorrection correction;
    double rule_error = 0, error = 0;  ///< mean |u - f|^2 of held-out items before and after
};

/// Learns a correction by gradient boosting with vectors as values (Friedman 2001): each round adds the stump that
/// reduces the squared error of f most, over a random tenth of the features, at a fifth of its full size. Held-out
/// items tell the number of rounds, then all items are learned from. No stumps if they gain less than a tenth.
/// Deterministic, whatever the number of threads.
LearnedCorrection learn_correction(
    const CorrectionTraining& training, const std::function<void()>& progress = [] {});

}  // namespace exemplar
