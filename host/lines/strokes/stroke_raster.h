#pragma once

#include <span>

#include "host/imaging/image.h"
#include "host/lines/strokes/strokes.h"
#include "host/lines/strokes/style.h"

namespace exemplar {

/// The readable reference of how the device draws strokes. Draws the visible ways of strokes over an image of 3 or 4
/// channels in [0, 1] (sRGB-encoded, alpha not premultiplied), in their order. A pixel center is covered by the point
/// of a stroke's center line that has it farthest inside of the stroke, or else nearest to it. If that is `distance`
/// pixels away, and the stroke is `width` wide there, it covers clamp(width / 2 + 0.5 - distance, 0, 1), times the
/// opacity of the style and of that point, times that of the texture (an empty one is opaque) at the point's parameter
/// and at distance / (width / 2) across. A stroke that covers a pixel twice counts once. Colors are mixed as they are
/// encoded. Throws UsageError for another number of channels.
void draw_strokes(std::span<const Stroke> strokes, const LineStyle& style, const Image& texture, FloatImage& image);

}  // namespace exemplar
