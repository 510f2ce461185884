#pragma once

#include <span>

#include "host/hatching/fields/hatch_stroke.h"
#include "host/hatching/fields/hatching_fields.h"

namespace exemplar {

/// How much thicker or thinner than their target match_tone() may make strokes.
constexpr float k_least_width_factor = 0.6f, k_most_width_factor = 1.6f;

/// Makes strokes thicker where a drawing is lighter than target_tone(), and thinner where it is darker, so that gaps
/// between strokes, and how strokes overlap, change its tones less. In each iteration the width of every point is
/// multiplied by the ratio of target to tone in a window six spacings wide around it, a mean over three spacings to
/// both sides along the stroke, and kept within these factors of the thickness there. More iterations gain little.
/// Throws UsageError for strokes that drawn_ink() does not take, or a negative number of iterations.
void match_tone(std::span<HatchStroke> strokes, const HatchingFields& fields, int iterations = 3);

}  // namespace exemplar
