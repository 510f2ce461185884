#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "host/imaging/camera.h"
#include "host/lines/chains.h"
#include "host/lines/lines.h"

namespace exemplar {

/// How thick the strokes of a line type are (thesis Sec. 5.7, after Goodwin et al. 2007): with z the depth along the
/// camera's axis in units of StrokeView::unit_depth (1 in parallel projection), kr the radial curvature times the
/// feature size, both at the point: T = clamp(c / (z (max(kr, 0) + epsilon))), c = width * epsilon.
struct StrokeThickness {
    float width = 2.5f;  ///< pixels, where kr is zero at unit depth
    float epsilon = 0.25f;
    float least = 0.6f, most = 6;  ///< pixels
    float taper = 12;              ///< pixels over which a stroke grows from nothing at its ends; 0: blunt
};

/// Where strokes are seen from.
struct StrokeView {
    Camera camera;
    int width = 0, height = 0;  ///< pixels
    float unit_depth = 1;       ///< mesh units
    float feature_size = 1;     ///< mesh units
};

/// A point of a chain in the picture.
struct StrokePoint {
    Vec2 position = Vec2::Zero();  ///< pixels; x right, y down, (0, 0) the image's upper left corner
    Vec2 normal = Vec2::UnitY();   ///< unit, across the stroke: to the right of the way on
    float depth = 0;               ///< in [0, 1], as Camera::project has it
    float width = 0;               ///< pixels; tapered towards the ends of what is visible
    float opacity = 1;             ///< line_opacity() of its strength
    float parameter = 0;           ///< pixels from the chain's start, along it
    bool visible = true;           ///< the way on to the next point is not hidden
};

/// A chain as it is drawn: one point more than it has links; of a closed one the last point is the first.
struct Stroke {
    std::vector<StrokePoint> points;
    bool closed = false;
};

/// The strokes of chains, in their order. `hidden` has a flag per segment (see hidden_segments); empty: all are
/// visible. Throws UsageError if sizes do not fit.
std::vector<Stroke> make_strokes(const LineSurface& surface, LineType type, std::span<const LineSegment> segments,
                                 std::span<const Chain> chains, std::span<const std::uint8_t> hidden,
                                 const StrokeView& view, const LineThresholds& thresholds,
                                 const StrokeThickness& thickness);

}  // namespace exemplar
