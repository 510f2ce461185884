#pragma once

#include <cstddef>
#include <span>

#include "host/hatching/fields/hatch_stroke.h"
#include "host/hatching/fields/hatching_fields.h"

namespace exemplar {

/// How far strokes of a layer are from each other, beside the target spacing d there.
struct SpacingMeasure {
    std::size_t gaps = 0;     ///< that were measured
    double median_error = 0;  ///< of |distance - d| / d
    double mean_ratio = 0;    ///< of distance / d
    double least_ratio =
        0;  ///< from any point of a stroke to any other stroke's center line; 1 if all are at d or more
};

/// Measures from every point of a stroke, perpendicular to it, to the next other stroke of its layer on each side; gaps
/// that leave the layer on the way, or are over three spacings wide, do not count. Points beyond the picture, or where
/// their layer has no strokes, are left out. Throws UsageError for a stroke of no layer.
SpacingMeasure measure_spacing(std::span<const HatchStroke> strokes, const HatchingFields& fields);

/// How dark a drawing is beside target_tone().
struct ToneMeasure {
    std::size_t pixels = 0;   ///< that were measured: all that are hatched
    double median_error = 0;  ///< of |tone - target| / target
    double mean_ratio = 0;    ///< of all ink to all of the target
};

/// How far to each side of a pixel tones are measured: one and a half spacings, in pixels.
int tone_reach(float spacing);

/// Measures means over windows three spacings wide around the pixels that are hatched. Throws as drawn_ink().
ToneMeasure measure_tone(std::span<const HatchStroke> strokes, const HatchingFields& fields);

}  // namespace exemplar
