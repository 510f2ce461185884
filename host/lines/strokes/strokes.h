#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "host/imaging/camera.h"
#include "host/lines/strokes/chains.h"
#include "host/lines/extraction/lines.h"
#include "host/lines/strokes/visibility.h"

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
/// T at a point of a radial curvature (times the feature size) and a depth (in units): pixels, not tapered.
inline float stroke_width(const StrokeThickness& thickness, float radial_curvature, float depth) {
    const float width =
        thickness.width * thickness.epsilon / (depth * (std::max(radial_curvature, 0.0f) + thickness.epsilon));
    return std::clamp(width, thickness.least, thickness.most);
}
/// The share of its width that a stroke has `distance` pixels from the end of what is visible of it: a quarter of an
/// ellipse, sqrt(x (2 - x)) with x = min(1, distance / taper).
inline float stroke_taper(float distance, float taper) {
    if (!(distance < taper)) return 1;
    const float x = std::max(distance, 0.0f) / taper;
    return std::sqrt(x * (2 - x));
}

/// The share of its width that a stroke has where a piece of it `length` pixels long leads only `across` pixels on: 1
/// up to a turn by 120 degrees or so, less towards a cusp, where the way back covers the way there.
inline float straightness(float across, float length) {
    return length > 0 ? std::min(1.0f, 2 * across / length) : 1;
}

/// See make_strokes: how far points are moved, in pixels, and within how many points to each side.
constexpr float k_least_calm = 3, k_most_calm = 10;
constexpr int k_calm_points = 8, k_calm_reach = 2;

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

/// A chain as it is drawn: the points where its links begin and the last one's end, and points between them where
/// visibility changes; links longer than a fifth of the taper are cut into even pieces, so that it shows on them. Of a
/// closed one the last point is the first.
struct Stroke {
    std::vector<StrokePoint> points;
    bool closed = false;
};

/// The strokes of chains, in their order. Zero sets and extrema wind a little from face to face; so a point of theirs
/// is moved to the mean of the chain around it, in the picture: to each side as far as the second next point, but no
/// less than 3 and no more than 10 pixels, and no further than 8 points or the chain's end (its end points stay). The
/// normal is perpendicular to the way between the ends of that part; of creases and boundaries, to that from the second
/// point before to the second after. The parameter is the sum of the pixel distances up to a point before it is moved,
/// the width stroke_width() of the depth and the radial curvature there (at a vertex (k1 u^2 + k2 v^2) / (u^2 + v^2),
/// or the mean curvature where the eye is along the normal; zero if the surface has no curvature). With tapers it is
/// multiplied by the straightness() of the part that the point is the mean of, and by stroke_taper() of the distance
/// along the chain to the nearest end of the visible run that the point is in. Where a closed chain's
/// first point is visible, its runs go on over it, and if all is visible nothing is tapered. `visible` has the visible
/// parts of each segment; null: all are. Throws UsageError if sizes do not fit, or a thickness is out of range (width,
/// epsilon and most positive, least in [0, most], taper not negative).
std::vector<Stroke> make_strokes(const LineSurface& surface, LineType type, std::span<const LineSegment> segments,
                                 std::span<const Chain> chains, const VisibleParts* visible, const StrokeView& view,
                                 const LineThresholds& thresholds, const StrokeThickness& thickness);

}  // namespace exemplar
