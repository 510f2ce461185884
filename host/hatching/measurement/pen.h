#pragma once

#include <span>

#include "host/hatching/tracing/traced_strokes.h"
#include "host/imaging/image.h"

namespace exemplar {

/// The taper of strokes when a drawing has too few ends to tell, pixels.
constexpr float k_usual_taper = 6;

/// Measures over how many pixels the strokes of a drawing end in a point, as taper_strokes tapers them: 0 if they end
/// bluntly. Ends are compared with the stroke farther inside by how much ink lies across it; what is missing beyond the
/// place where half is left grows with the taper. Only ends count that lie free, of strokes of at least 20 pixels; the
/// result is their median, or k_usual_taper if there are fewer than 20. Strokes are measured (see measure_profiles);
/// `paper`: mean darkness of paper, `softness`: of edges (estimate_softness).
float measure_taper(const FloatImage& darkness, float paper, float softness, std::span<const TracedStroke> strokes);

/// Returns the same of strokes whose widths are known: the median over the ends of strokes of at least 20 pixels.
float known_taper(std::span<const TracedStroke> strokes);

/// Returns how wide lines would be in black, pixels: the median of the ink across them, as of outlines that were drawn.
/// Zero without lines.
float measure_line_width(const FloatImage& darkness, float paper, std::span<const TracedStroke> lines);

}  // namespace exemplar
