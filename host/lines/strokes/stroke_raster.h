#pragma once

#include <span>

#include "host/imaging/image.h"
#include "host/lines/strokes/strokes.h"
#include "host/lines/strokes/style.h"

namespace exemplar {

/// Draws the visible parts of strokes over an image, in their order; the reference of how the device draws them. The
/// image has 3 or 4 channels in [0, 1] (sRGB-encoded, alpha not premultiplied).
/// A pixel belongs to the point of the center line for which width / 2 - distance is largest, with the distance of
/// its center and the width of the stroke there. Its opacity is clamp(width / 2 + 0.5 - distance, 0, 1) times those
/// of the style, the point and the texture (an empty one is opaque), the latter at the point's parameter and at
/// distance / (width / 2) across. Each stroke covers a pixel once. Colors are mixed as encoded. Throws UsageError
/// for another number of channels.
void draw_strokes(std::span<const Stroke> strokes, const LineStyle& style, const Image& texture, FloatImage& image);

}  // namespace exemplar
