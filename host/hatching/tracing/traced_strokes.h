#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "host/hatching/tracing/skeleton_graph.h"
#include "host/imaging/image.h"
#include "host/mesh/mesh.h"

namespace exemplar {

/// A point of a stroke's center line and the stroke's properties there; distances in pixels.
struct TracedPoint {
    Vec2 center = Vec2::Zero();
    float orientation = 0;     ///< radians in [0, pi)
    float thickness = 0;       ///< 0: not measured yet
    float intensity = 0;       ///< 0: not measured yet
    float spacing = 0;         ///< 0: no neighbor
    float length = 0;          ///< of the whole stroke
    bool oriented = false;     ///< the orientation was measured in the drawing rather than along the center line
    bool profiled = false;     ///< thickness and intensity were measured here rather than elsewhere on the stroke
    bool at_crossing = false;  ///< in the ink of another stroke, or in a gap that was bridged
};

/// A stroke, traced through its crossings with others. Its points are at most about a pixel and a half apart.
struct TracedStroke {
    std::vector<TracedPoint> points;  ///< two at least
    bool closed = false;
    float width = 0;  ///< to within a pixel, from the mask of its ink
};

/// Joins the lines of a skeleton to strokes. Where lines meet, and where a fainter stroke disappears in a darker
/// one, the straightest pairs are joined, if they turn by less than about 35 degrees. Two strokes that cross at a
/// small angle both pass along the line they share. `width`: of strokes, per pixel of the skeleton. Gaps are bridged
/// where `darkness` is at least `faintest` all the way. Strokes shorter than twice their width or than three pixels
/// are left out. Center lines run through pixel centers, and straight through crossings; orientations are those of
/// center lines.
std::vector<TracedStroke> trace_strokes(const PixelMask& skeleton, const FloatImage& width, const FloatImage& darkness,
                                        float min_darkness);

/// Sets the orientations that are not measured yet to that of the center line, fitted to the points within about two
/// widths along the stroke.
void orient_along(TracedStroke& stroke);

/// Returns the direction in which a stroke leaves its front or back.
Vec2 end_direction(const TracedStroke& stroke, bool back);
/// Returns how far a stroke's ink continues from its first or last point in that direction until it is half as dark,
/// in pixels; negative if the point is beyond that. Returns nothing if the ink does not end within about two widths,
/// as where it meets another stroke.
std::optional<float> distance_to_tip(const FloatImage& darkness, const TracedStroke& stroke, bool back, float width);

/// Returns the length of the center line, measured along the orientations, so that jitter across them adds nothing.
float length_along(const TracedStroke& stroke);

}  // namespace exemplar
