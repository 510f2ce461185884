#pragma once

#include <span>

#include "host/hatching/animation/carried_strokes.h"
#include "host/hatching/fields/hatch_stroke.h"

namespace exemplar {

/// Strokes are the same as far as their center lines are no farther apart, in pixels.
constexpr float k_same_stroke = 0.5f;

/// How the strokes of a picture differ from those of the picture before, on the surface: what moves with it stays.
struct HatchingFlicker {
    float drawn = 0;     ///< pixels of length that are drawn
    float appeared = 0;  ///< the share of them that no stroke of the same layer was at before
    float vanished = 0;  ///< the share of what was drawn, and still could be seen, that no stroke of its layer is at
    float slip = 0;      ///< pixels, the mean: from an end of a stroke to where the nearest end of its layer is now
};

/// `before`: the strokes of the picture before, carried to this one.
HatchingFlicker measure_flicker(std::span<const HatchStroke> strokes, std::span<const CarriedStroke> before);
/// The mean over pictures, those with more strokes counting more.
HatchingFlicker mean_flicker(std::span<const HatchingFlicker> pictures);

}  // namespace exemplar
