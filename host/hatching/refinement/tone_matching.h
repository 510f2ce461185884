#pragma once

#include <span>

#include "host/hatching/fields/hatch_stroke.h"
#include "host/hatching/fields/hatching_fields.h"

namespace exemplar {

/// Limits of the factor by which match_tone() changes the target thickness of strokes.
constexpr float k_min_width_factor = 0.6f, k_max_width_factor = 1.6f;

/// Makes strokes thicker where a drawing is lighter than target_tone(), and thinner where it is darker, which
/// compensates for gaps and overlaps of strokes. Each iteration multiplies the width at every point by the ratio of
/// target to tone in a window six spacings wide, averaged over three spacings to both sides along the stroke, and
/// clamps it to these factors of the thickness there. More iterations gain little. Throws UsageError for strokes
/// that render_ink() rejects, or a negative number of iterations.
void match_tone(std::span<HatchStroke> strokes, const HatchingFields& fields, int iterations = 3);

}  // namespace exemplar
