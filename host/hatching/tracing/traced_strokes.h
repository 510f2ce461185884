#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "host/hatching/tracing/skeleton_graph.h"
#include "host/imaging/image.h"
#include "host/mesh/mesh.h"

namespace exemplar {

/// A point of a stroke's center line and what is known about the stroke there; distances in pixels.
struct TracedPoint {
    Vec2 center = Vec2::Zero();
    float orientation = 0;     ///< radians in [0, pi)
    float thickness = 0;       ///< 0: not measured yet
    float intensity = 0;       ///< 0: not measured yet
    float spacing = 0;         ///< 0: no neighbor
    float length = 0;          ///< of the whole stroke
    bool oriented = false;     ///< the orientation was measured in the drawing rather than along the center line
    bool profiled = false;     ///< thickness and intensity were measured here rather than elsewhere on the stroke
    bool at_crossing = false;  ///< in the ink of another stroke, or between the pieces of its own
};

/// One stroke, followed through its crossings with others. Its points are at most about a pixel and a half apart.
struct TracedStroke {
    std::vector<TracedPoint> points;  ///< two at least
    bool closed = false;
    float width = 0;  ///< to within a pixel, from the mask of its ink
};

/// Puts the lines of a skeleton together to strokes. Where lines meet, and where a fainter stroke is lost in a darker
/// one, those continue each other that do so most nearly straight, if they turn by less than about 35 degrees; two
/// strokes that share a line, as they cross at a small angle, both pass along it. `width` is that of strokes, per pixel
/// of the skeleton; gaps are bridged where all of `darkness` between is at least `faintest`. Strokes shorter than
/// twice their width or than three pixels are left out. Center lines are pixels' centers, straight through crossings;
/// orientations are those of center lines.
std::vector<TracedStroke> trace_strokes(const PixelMask& skeleton, const FloatImage& width, const FloatImage& darkness,
                                        float faintest);

/// Sets the orientations of points that are not yet measured to those of the center line around them, from points that
/// are within about two widths along the stroke.
void orient_along(TracedStroke& stroke);

/// The direction in which a stroke leaves its front or back.
Vec2 way_out(const TracedStroke& stroke, bool back);
/// How far from its first or last point a stroke's ink goes on in that direction until it is half as dark, in pixels;
/// negative if the point is beyond. Nothing if it does not end within two widths, as where it meets another stroke.
std::optional<float> way_to_tip(const FloatImage& darkness, const TracedStroke& stroke, bool back, float width);

/// Length of the center line as walked along the orientations, so that jitter across them adds nothing.
float length_along(const TracedStroke& stroke);

}  // namespace exemplar
