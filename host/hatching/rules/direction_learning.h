#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "host/hatching/fields/hatching_fields.h"
#include "host/hatching/rules/direction_correction.h"
#include "host/hatching/rules/hatching_examples.h"
#include "host/hatching/rules/orientation_mixture.h"

namespace exemplar {

/// Input of learn_corrections(): strokes, and the rules that their segments have.
struct CorrectedStrokes {
    const HatchingExamples& views;
    std::span<const std::uint32_t> rows;     ///< on center lines
    std::span<const std::int32_t> segment;   ///< of each row, as a prediction would have it
    std::span<const OrientationRule> rules;  ///< per segment
    std::uint64_t seed;
};

/// Learns where the strokes of each layer depart from the rules. Strokes of cross-hatching belong to the second layer
/// if they run along the second rule rather than the first or, where there is no second rule, more than 45 degrees off
/// the first. A layer with too few strokes has no correction.
std::array<LearnedCorrection, k_hatch_layers> learn_corrections(
    const CorrectedStrokes& strokes, const std::function<void()>& progress = [] {});

}  // namespace exemplar
