#pragma once

#include <span>
#include <vector>

#include "host/hatching/fields/hatch_stroke.h"
#include "host/hatching/tracing/ink_mask.h"
#include "host/hatching/tracing/traced_drawing.h"

namespace exemplar {

/// A stroke whose center line, width and darkness are known, as of a drawing that is no picture. In pixels of the view.
struct StrokePath {
    std::vector<Vec2> points;   ///< two at least
    std::vector<float> widths;  ///< one per point
    bool closed = false;        ///< the last point is joined to the first, which it does not repeat
    float darkness = 1;         ///< in (0, 1]: 1 is black
    bool outline = false;       ///< said to be an outline, and no hatching
};

/// Returns strokes as render_ink draws them, whose points are at most 2 pixels apart.
std::vector<HatchStroke> drawn_strokes(std::span<const StrokePath> paths);

/// Strokes that need no tracing.
struct KnownDrawing {
    TracedDrawing traced;                ///< thickness, intensity and orientation are known at each point
    std::vector<TracedStroke> outlines;  ///< those that are said to be outlines
};
/// Returns strokes in the form that tracing a picture yields: points at most a pixel apart, cut where `mask` (one
/// channel, not zero inside of the object) ends. Strokes fainter than `min_darkness`, and pieces shorter than a
/// pixel, are left out. `darkness`: the strokes as render_ink draws them, of the mask's size.
KnownDrawing known_drawing(std::span<const StrokePath> paths, const FloatImage& darkness, const PixelMask& mask,
                           float min_darkness);

}  // namespace exemplar
