#pragma once

#include <span>

#include "host/hatching/animation/advected_strokes.h"
#include "host/hatching/fields/hatch_stroke.h"

namespace exemplar {

/// Parts of strokes count as the same if their center lines are no farther apart, in pixels.
constexpr float k_same_stroke = 0.5f;

/// How the strokes of a frame differ from those of the previous frame, on the surface: strokes that move with it do
/// not count as changed.
struct HatchingFlicker {
    float drawn = 0;     ///< total length of strokes, pixels
    float appeared = 0;  ///< share of it without a stroke of the same layer in the previous frame
    float vanished = 0;  ///< share of the previous length, still visible, without a stroke of its layer now
    float slip = 0;      ///< mean distance, pixels, from an end of a previous stroke to the nearest of its layer
};

/// Measures the flicker of a frame. `before`: the strokes of the previous frame, advected to this one.
HatchingFlicker measure_flicker(std::span<const HatchStroke> strokes, std::span<const AdvectedStroke> before);
/// Returns the mean over frames, weighted by their length of strokes.
HatchingFlicker mean_flicker(std::span<const HatchingFlicker> pictures);

}  // namespace exemplar
