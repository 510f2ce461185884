#pragma once

#include <vector>

#include "host/hatching/tracing/ink_mask.h"
#include "host/hatching/tracing/traced_strokes.h"
#include "host/imaging/image.h"

namespace exemplar {

/// The strokes of a drawing as lines, before anything about them is measured.
struct TracedDrawing {
    PixelMask ink;     ///< see ink_pixels
    FloatImage width;  ///< per pixel of ink, how wide the stroke is, to within a pixel
    PixelMask skeleton;
    std::vector<TracedStroke> strokes;
};

/// Finds the strokes of a drawing (darkness, one channel) inside of `mask`. The width is twice the distance to the
/// nearest pixel that is not ink, which is what a breadth-first search from the skeleton to the nearest pixel of less
/// than half the darkness finds (thesis App. B.1).
TracedDrawing trace_drawing(const FloatImage& darkness, const PixelMask& mask, float faintest);

}  // namespace exemplar
