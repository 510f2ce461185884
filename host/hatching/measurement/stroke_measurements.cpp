#include "host/hatching/measurement/stroke_measurements.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "host/core/errors.h"
#include "host/core/parallel.h"
#include "host/core/statistics.h"
#include "host/hatching/measurement/hatching_levels.h"
#include "host/hatching/measurement/pen.h"
#include "host/hatching/measurement/stroke_map.h"
#include "host/hatching/measurement/stroke_properties.h"
#include "host/hatching/tracing/drawing_filters.h"
#include "host/hatching/tracing/ink_mask.h"
#include "host/hatching/tracing/traced_drawing.h"
#include "host/hatching/tracing/traced_strokes.h"

namespace exemplar {
namespace {

constexpr float k_min_crossing_angle = std::numbers::pi_v<float> / 12;
constexpr float k_paper_distance = 3;  ///< min distance of paper from ink, pixels
constexpr std::size_t k_min_paper_pixels = 100;
constexpr float k_spacings_per_thickness = 20, k_min_max_spacing = 24;
constexpr float k_min_outline_reach = 3.5f;  ///< pixels
constexpr float k_owned_edge = 1.5f;         ///< max distance of a stroke's pixels beyond half of its width, pixels

void check_drawing_and_mask(const FloatImage& darkness, const Image& mask) {
    if (darkness.channels != 1 || mask.channels != 1)
        throw UsageError(fmt::format("strokes are measured in images of one channel; the drawing has {}, the mask {}",
                                     darkness.channels, mask.channels));
    if (darkness.width != mask.width || darkness.height != mask.height)
        throw UsageError(
            fmt::format("a drawing of {} x {} pixels and a mask of {} x {}: warp the drawing into the view",
                        darkness.width, darkness.height, mask.width, mask.height));
}

/// Returns the mean darkness far from ink: not quite zero in a noisy scan.
float paper_darkness(const FloatImage& darkness, const PixelMask& ink) {
    const std::vector<std::int32_t> nearest = nearest_sites(darkness.width, darkness.height, ink.data);
    double sum = 0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < nearest.size(); ++i) {
        if (nearest[i] == k_no_site ||
            pixel_distance(static_cast<std::int32_t>(i), nearest[i], darkness.width) < k_paper_distance)
            continue;
        sum += darkness.data[i];
        ++count;
    }
    return count < k_min_paper_pixels ? 0 : static_cast<float>(sum / static_cast<double>(count));
}

template <typename Value>
float median_over_points(std::span<const TracedStroke> strokes, Value value) {
    std::vector<float> values;
    for (const TracedStroke& stroke : strokes)
        for (const TracedPoint& point : stroke.points)
            if (value(point) > 0) values.push_back(value(point));
    return upper_median(values);
}

/// Gives each pixel of ink in the mask what was measured at the nearest point.
void spread(const PixelMask& ink, const Image& mask, const PixelMask& crossing, std::span<const TracedStroke> strokes,
            const StrokeMap& map, StrokeMeasurements& m) {
    parallel_for(
        static_cast<std::size_t>(m.height),
        [&](std::size_t row) {
            for (int x = 0; x < m.width; ++x) {
                const int y = static_cast<int>(row);
                const std::size_t i = row * static_cast<std::size_t>(m.width) + static_cast<std::size_t>(x);
                if (!ink.data[i] || !mask.data[i]) continue;
                const PointId id = map.nearest(x, y);
                const TracedPoint& point = strokes[id.stroke].points[id.point];
                if (map.distance(x, y) > 0.5f * point.thickness + k_owned_edge) continue;
                m.stroke[i] = 1;
                m.stroke_id[i] = id.stroke;
                m.intensity[i] = point.intensity;
                m.thickness[i] = point.thickness;
                m.orientation[i] = point.orientation;
                m.spacing[i] = point.spacing;
                m.length[i] = point.length;
                m.intersection[i] = crossing.data[i];
            }
        },
        16);
}

void mark_ends(std::span<const TracedStroke> strokes, const StrokeMap& map, const Image& mask, StrokeMeasurements& m) {
    for (const TracedStroke& stroke : strokes) {
        if (stroke.closed) continue;
        for (const TracedPoint& end : {stroke.points.front(), stroke.points.back()}) {
            const auto [x, y] = map.pixel_of(end);
            if (mask.pixel(x, y)[0]) m.boundary[static_cast<std::size_t>(y) * m.width + x] = 1;
        }
    }
}

/// Returns how far from the view's outlines drawn ones may lie, in pixels.
float outline_reach(std::span<const TracedStroke> strokes) {
    std::vector<float> widths;
    for (const TracedStroke& stroke : strokes) widths.push_back(stroke.width);
    return std::max(k_min_outline_reach, 1.5f * upper_median(widths));
}

void mark_outlines(std::span<const TracedStroke> outlines, StrokeMeasurements& m) {
    for (const TracedStroke& outline : outlines)
        for (const TracedPoint& point : outline.points) {
            const int x = std::clamp(static_cast<int>(point.center.x()), 0, m.width - 1);
            const int y = std::clamp(static_cast<int>(point.center.y()), 0, m.height - 1);
            m.outline[static_cast<std::size_t>(y) * m.width + x] = 1;
        }
}

/// Whether hatching of a stroke's level ends within `reach` pixels beyond its front or back.
bool ends_at_border(const TracedStroke& stroke, bool back, float reach, const StrokeMap& map,
                    const StrokeMeasurements& m) {
    const TracedPoint& end = back ? stroke.points.back() : stroke.points.front();
    const auto level_at = [&](const TracedPoint& point) {
        const auto [x, y] = map.pixel_of(point);
        return m.level[static_cast<std::size_t>(y) * m.width + x];
    };
    TracedPoint beyond = end;
    beyond.center += reach * end_direction(stroke, back);
    const auto size = Vec2(static_cast<float>(m.width), static_cast<float>(m.height));
    const bool is_inside = (beyond.center.array() >= 0).all() && (beyond.center.array() < size.array()).all();
    return !is_inside || level_at(beyond) < level_at(end);
}

/// Marks strokes with both ends at the border of their hatching: they may have been meant to be longer.
void mark_bounded(std::span<const TracedStroke> strokes, const StrokeMap& map, StrokeMeasurements& m) {
    const float reach = 1.5f * m.median_spacing;
    std::vector<bool> bounded;
    for (const TracedStroke& stroke : strokes)
        bounded.push_back(!stroke.closed && ends_at_border(stroke, false, reach, map, m) &&
                          ends_at_border(stroke, true, reach, map, m));
    for (std::size_t i = 0; i < m.size(); ++i)
        m.bounded[i] = m.stroke_id[i] >= 0 && bounded[static_cast<std::size_t>(m.stroke_id[i])] ? 1 : 0;
}

StrokeMeasurements empty_measurements(int width, int height) {
    StrokeMeasurements m;
    m.width = width, m.height = height;
    for (auto* image : {&m.stroke, &m.skeleton, &m.outline, &m.bounded, &m.intersection, &m.level, &m.boundary})
        image->resize(m.size());
    for (auto* image : {&m.intensity, &m.thickness, &m.orientation, &m.spacing, &m.length}) image->resize(m.size());
    m.stroke_id.assign(m.size(), -1);
    return m;
}

/// Sets the length of each stroke to that of its center line.
void set_lengths(std::span<TracedStroke> strokes) {
    for (TracedStroke& stroke : strokes) {
        float length = 0;
        for (std::size_t i = 1; i < stroke.points.size(); ++i)
            length += (stroke.points[i].center - stroke.points[i - 1].center).norm();
        for (TracedPoint& point : stroke.points) point.length = std::max(length, 1.0f);
    }
}

/// Measures all properties of the strokes' points, without smoothing; if they are `known`, only those that depend on
/// other strokes. Returns the crossings.
std::vector<StrokeCrossing> measure_points(const FloatImage& darkness, const PixelMask& ink,
                                           const MeasuringOptions& options, bool known,
                                           std::vector<TracedStroke>& strokes, StrokeMeasurements& m) {
    std::vector<StrokeCrossing> crossings = find_crossings(strokes, m.width, m.height, k_min_crossing_angle);
    const PixelMask crossing = crossing_pixels(crossings, m.width, m.height);
    mark_crossings(crossing, strokes);
    const StrokeMap map(strokes, m.width, m.height);
    const float paper = paper_darkness(darkness, ink);
    if (known) {
        set_lengths(strokes);
    } else {
        measure_orientations(darkness, map, crossing, strokes);
        m.softness = estimate_softness(darkness, paper, map, crossing, strokes);
        measure_profiles(darkness, paper, m.softness, map, crossing, strokes);
        measure_lengths(darkness, strokes);
    }
    m.median_thickness = median_over_points(strokes, [](const TracedPoint& p) { return p.thickness; });
    const float largest = options.max_spacing > 0
                              ? options.max_spacing
                              : std::max(k_min_max_spacing, k_spacings_per_thickness * m.median_thickness);
    measure_spacings(crossings, options.similar, largest, strokes);
    m.taper = known ? known_taper(strokes) : measure_taper(darkness, paper, m.softness, strokes);
    m.median_spacing = median_over_points(strokes, [](const TracedPoint& p) { return p.spacing; });
    return crossings;
}

/// Measures strokes that were traced in a picture, or are `known`, into measurements whose outlines are marked.
void measure_traced(TracedDrawing& drawing, const FloatImage& darkness, const Image& mask,
                    const MeasuringOptions& options, bool known, StrokeMeasurements& m) {
    std::vector<TracedStroke>& strokes = drawing.strokes;
    if (strokes.empty()) return;
    const std::vector<StrokeCrossing> crossings = measure_points(darkness, drawing.ink, options, known, strokes, m);
    m.intersections = confirmed_intersections(crossings, darkness, drawing.skeleton, strokes);
    m.level = hatching_levels(strokes, m.intersections, mask, options.max_single_intersections, m.median_spacing);
    m.boundary = level_boundaries(m.level, mask);
    if (options.smoothing > 0 && m.median_spacing > 0)
        smooth_properties(options.smoothing * m.median_spacing, 0.5f * options.similar, strokes);
    const StrokeMap map(strokes, m.width, m.height);
    spread(drawing.ink, mask, crossing_pixels(crossings, m.width, m.height), strokes, map, m);
    mark_ends(strokes, map, mask, m);
    mark_bounded(strokes, map, m);
    for (std::size_t i = 0; i < m.size(); ++i) m.skeleton[i] = drawing.skeleton.data[i] && m.stroke[i] && !m.outline[i];
}

}  // namespace

StrokeMeasurements measure_strokes(const FloatImage& darkness, const Image& mask, const MeasuringOptions& options,
                                   const ViewOutlines* outlines) {
    check_drawing_and_mask(darkness, mask);
    StrokeMeasurements m = empty_measurements(darkness.width, darkness.height);
    if (m.size() == 0) return m;
    TracedDrawing drawing = trace_drawing(darkness, mask, options.min_darkness);
    if (outlines) {
        const std::vector<TracedStroke> drawn =
            take_outlines(drawing.strokes, *outlines, outline_reach(drawing.strokes));
        mark_outlines(drawn, m);
        m.outline_width = measure_line_width(darkness, paper_darkness(darkness, drawing.ink), drawn);
    }
    measure_traced(drawing, darkness, mask, options, false, m);
    return m;
}

StrokeMeasurements measure_paths(std::span<const StrokePath> paths, const FloatImage& darkness, const Image& mask,
                                 const MeasuringOptions& options, const ViewOutlines* outlines) {
    check_drawing_and_mask(darkness, mask);
    StrokeMeasurements m = empty_measurements(darkness.width, darkness.height);
    if (m.size() == 0) return m;
    KnownDrawing drawing = known_drawing(paths, darkness, mask, options.min_darkness);
    std::vector<TracedStroke>& strokes = drawing.traced.strokes;
    if (drawing.outlines.empty() && outlines)
        drawing.outlines = take_outlines(strokes, *outlines, outline_reach(strokes));
    mark_outlines(drawing.outlines, m);
    // Lines are drawn in black ink: a gray one is as wide as its ink would be.
    m.outline_width = median_over_points(drawing.outlines,
                                         [](const TracedPoint& point) { return point.thickness * point.intensity; });
    measure_traced(drawing.traced, darkness, mask, options, true, m);
    return m;
}

void restrict_to(const Image& mask, StrokeMeasurements& m) {
    std::vector<float> thickness, spacing;
    for (std::size_t i = 0; i < m.size(); ++i) {
        if (!mask.data[i]) {
            for (auto* image : {&m.stroke, &m.skeleton, &m.outline, &m.bounded, &m.intersection, &m.level, &m.boundary})
                (*image)[i] = 0;
            m.stroke_id[i] = -1;
        }
        if (m.skeleton[i]) thickness.push_back(m.thickness[i]);
        if (m.skeleton[i] && m.spacing[i] > 0) spacing.push_back(m.spacing[i]);
    }
    std::erase_if(m.intersections, [&](const Vec2& place) {
        const int x = std::clamp(static_cast<int>(place.x()), 0, m.width - 1);
        const int y = std::clamp(static_cast<int>(place.y()), 0, m.height - 1);
        return mask.pixel(x, y)[0] == 0;
    });
    m.median_thickness = thickness.empty() ? 0 : upper_median(thickness);
    m.median_spacing = spacing.empty() ? 0 : upper_median(spacing);
}

}  // namespace exemplar
