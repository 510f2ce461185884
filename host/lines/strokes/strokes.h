#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "host/imaging/camera.h"
#include "host/lines/extraction/lines.h"
#include "host/lines/strokes/chains.h"
#include "host/lines/strokes/visibility.h"

namespace exemplar {

/// Thickness T = clamp(c / (z (max(kr, 0) + epsilon))), c = width * epsilon, of the strokes of a line type (thesis
/// Sec. 5.7, after Goodwin et al. 2007). z is the depth along the camera's axis in units of StrokeView::unit_depth
/// (1 in parallel projection), kr the radial curvature times the feature size, both at the point.
struct StrokeThickness {
    float width = 2.5f;  ///< pixels, for kr = 0 at unit depth
    float epsilon = 0.25f;
    float least = 0.6f, most = 6;  ///< pixels
    float taper = 12;              ///< pixels over which a stroke widens from zero at its ends; 0: blunt ends
};
/// Returns T in pixels, without taper, for a radial curvature (times the feature size) and a depth (in unit depths).
inline float stroke_width(const StrokeThickness& thickness, float radial_curvature, float depth) {
    const float width =
        thickness.width * thickness.epsilon / (depth * (std::max(radial_curvature, 0.0f) + thickness.epsilon));
    return std::clamp(width, thickness.least, thickness.most);
}
/// Returns the factor of the width at `distance` pixels from the end of a visible run: a quarter of an ellipse,
/// sqrt(x (2 - x)) with x = min(1, distance / taper).
inline float stroke_taper(float distance, float taper) {
    if (!(distance < taper)) return 1;
    const float x = std::max(distance, 0.0f) / taper;
    return std::sqrt(x * (2 - x));
}

/// Returns the factor of the width of a piece of a stroke with arc length `length` and chord `across`, both in
/// pixels: 1 for turns of up to about 120 degrees, less towards a cusp, where the stroke would overlap itself.
inline float straightness(float across, float length) {
    return length > 0 ? std::min(1.0f, 2 * across / length) : 1;
}

/// Smoothing window of make_strokes on each side of a point: minimum and maximum length in pixels, maximum number of
/// points, and the number of points whose distance is the length.
constexpr float k_min_smoothing_window = 3, k_max_smoothing_window = 10;
constexpr int k_smoothing_window_points = 8, k_smoothing_window_reach = 2;
/// The least sum of two unit directions along a line for the line to have a tangent between them; it turns back below.
constexpr float k_least_tangent = 1e-3f;

/// Camera, picture and units that strokes are made for.
struct StrokeView {
    Camera camera;
    int width = 0, height = 0;  ///< pixels
    float unit_depth = 1;       ///< mesh units
    float feature_size = 1;     ///< mesh units
};

/// A point of a chain in the picture.
struct StrokePoint {
    Vec2 position = Vec2::Zero();  ///< pixels; x right, y down, (0, 0) the image's upper left corner
    Vec2 normal = Vec2::UnitY();   ///< unit, across the stroke, to the right of its direction
    float depth = 0;               ///< in [0, 1], as in Camera::project
    float width = 0;               ///< pixels; tapered towards the ends of visible runs
    float opacity = 1;             ///< line_opacity() of its strength
    float parameter = 0;           ///< arc length from the chain's start, in pixels
    std::uint32_t face = 0;        ///< that the piece to the next point lies on
    bool visible = true;           ///< whether the piece to the next point is visible
};

/// A chain as it is drawn. Points are the starts of its links, the end of the last one, and the places where
/// visibility changes. Links longer than a fifth of the taper are subdivided evenly, so that it shows on them. In a
/// closed stroke the last point equals the first.
struct Stroke {
    std::vector<StrokePoint> points;
    bool closed = false;
};

/// Makes the strokes of chains, in their order. `visible`: the visible parts of each segment; null: all are visible.
/// Position: zero sets and extrema zigzag from face to face, so each point, except the ends of open chains, moves to
/// the mean of the chain in a window around it: to each side up to the second next point, but 3 to 10 pixels and at
/// most 8 points, within the chain. Lines along edges are not moved. Normal: perpendicular to the chord of the
/// window, or of lines along edges, half way between the directions to both sides. Parameter: arc length in pixels
/// before points are moved. Width: stroke_width() of the depth and the radial curvature, interpolated from the vertices
/// ((k1 u^2 + k2 v^2) / (u^2 + v^2), the mean curvature where the eye is along the normal, or 0 without curvature).
/// With a taper it is multiplied by the straightness() of the window and by stroke_taper() of the distance along the
/// chain to the nearest end of the point's visible run. Runs of closed chains continue across their first point; if
/// everything is visible, they are not tapered. Nor are lines along edges, which go on around corners as other
/// strokes, and ends of contours on sharp edges, along which other contours go on.
/// Throws UsageError if sizes do not fit, or a thickness is out of range (width, epsilon and most positive, least in
/// [0, most], taper not negative).
std::vector<Stroke> make_strokes(const LineSurface& surface, LineType type, std::span<const LineSegment> segments,
                                 std::span<const Chain> chains, const VisibleParts* visible, const StrokeView& view,
                                 const LineThresholds& thresholds, const StrokeThickness& thickness);

}  // namespace exemplar
