#pragma once

#include <cstddef>
#include <span>

#include "host/hatching/fields/hatch_stroke.h"
#include "host/hatching/fields/hatching_fields.h"

namespace exemplar {

/// Distances between strokes of a layer, relative to the target spacing d there.
struct SpacingMeasure {
    std::size_t gaps = 0;     ///< number of measured gaps
    double median_error = 0;  ///< of |distance - d| / d
    double mean_ratio = 0;    ///< of distance / d
    double min_ratio =
        0;  ///< minimum of distance / d from a stroke point to another center line; 1 if all are at d or more
};

/// Measures the distance from every point of a stroke, perpendicular to it, to the next other stroke of its layer on
/// each side. Gaps over three spacings wide, or across pixels where the layer is not hatched, do not count. Points
/// outside of the picture or of the hatched area of their layer are left out. Throws UsageError for a stroke whose
/// layer does not exist.
SpacingMeasure measure_spacing(std::span<const HatchStroke> strokes, const HatchingFields& fields);

/// The tone of a drawing relative to target_tone().
struct ToneMeasure {
    std::size_t pixels = 0;   ///< number of measured pixels: all hatched ones
    double median_error = 0;  ///< of |tone - target| / target
    double mean_ratio = 0;    ///< total ink / total target
};

/// Returns half the width of the windows in which tones are measured, in pixels: one and a half spacings.
int tone_reach(float spacing);

/// Compares mean tones in windows three spacings wide around the hatched pixels. Throws like render_ink().
ToneMeasure measure_tone(std::span<const HatchStroke> strokes, const HatchingFields& fields);

}  // namespace exemplar
