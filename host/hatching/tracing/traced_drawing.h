#pragma once

#include <vector>

#include "host/hatching/tracing/ink_mask.h"
#include "host/hatching/tracing/traced_strokes.h"
#include "host/imaging/image.h"

namespace exemplar {

/// The strokes of a drawing as center lines, before their properties are measured.
struct TracedDrawing {
    PixelMask ink;     ///< see ink_pixels
    FloatImage width;  ///< width of the stroke per pixel of ink, to within a pixel
    PixelMask skeleton;
    std::vector<TracedStroke> strokes;
};

/// Traces the strokes of a drawing (darkness, one channel) inside of `mask`. The width is twice the distance to the
/// nearest pixel that is not ink. That is the pixel that a breadth-first search from the skeleton to the nearest
/// pixel of less than half the darkness finds (thesis App. B.1).
TracedDrawing trace_drawing(const FloatImage& darkness, const PixelMask& mask, float min_darkness);

}  // namespace exemplar
