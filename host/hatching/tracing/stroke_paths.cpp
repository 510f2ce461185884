#include "host/hatching/tracing/stroke_paths.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "host/hatching/tracing/drawing_filters.h"

namespace exemplar {
namespace {

constexpr float k_ink_smoothing_of_paths = 0.5f;  ///< as trace_drawing smooths

/// A center line and its width at each point.
struct WideLine {
    std::vector<Vec2> points;
    std::vector<float> widths;
};

/// Adds the points on a side of a path, which lies from `begin` to `end` along it; there are `pieces` of `per_point`
/// pixels.
void add_between(const StrokePath& path, std::size_t from, double begin, double end, double per_point,
                 std::size_t pieces, WideLine& out) {
    const std::size_t to = (from + 1) % path.points.size();
    while (out.points.size() < pieces) {
        const double place = per_point * static_cast<double>(out.points.size());
        if (place > end) return;
        const auto share = static_cast<float>((place - begin) / (end - begin));
        out.points.push_back(path.points[from] + share * (path.points[to] - path.points[from]));
        out.widths.push_back(path.widths[from] + share * (path.widths[to] - path.widths[from]));
    }
}

/// Returns points at equal distances along a path of at most `step`; the first again at the end of a closed one.
WideLine evenly_spaced(const StrokePath& path, float step) {
    const std::size_t corners = path.points.size(), sides = path.closed ? corners : corners - 1;
    std::vector<double> along{0};
    along.reserve(sides + 1);
    for (std::size_t i = 0; i < sides; ++i)
        along.push_back(along.back() + static_cast<double>((path.points[(i + 1) % corners] - path.points[i]).norm()));
    const auto pieces = static_cast<std::size_t>(std::max(1.0, std::ceil(along.back() / static_cast<double>(step))));
    WideLine out{{path.points.front()}, {path.widths.front()}};
    out.points.reserve(pieces + 1);
    out.widths.reserve(pieces + 1);
    for (std::size_t i = 0; i < sides; ++i)
        add_between(path, i, along[i], along[i + 1], along.back() / static_cast<double>(pieces), pieces, out);
    out.points.push_back(path.points[sides % corners]);
    out.widths.push_back(path.widths[sides % corners]);
    return out;
}

bool is_inside(const PixelMask& mask, const Vec2& place) {
    const float x = std::floor(place.x()), y = std::floor(place.y());
    if (!(x >= 0 && y >= 0 && x < static_cast<float>(mask.width) && y < static_cast<float>(mask.height))) return false;
    return mask.pixel(static_cast<int>(x), static_cast<int>(y))[0] != 0;
}

/// The direction of a line at one of its points, radians in [0, pi).
float direction_along(std::span<const Vec2> points, std::size_t i) {
    const Vec2 along = points[std::min(i + 1, points.size() - 1)] - points[i > 0 ? i - 1 : 0];
    const float angle = std::atan2(along.y(), along.x());
    const float positive = angle < 0 ? angle + std::numbers::pi_v<float> : angle;
    return positive < std::numbers::pi_v<float> ? positive : 0;
}

TracedStroke piece_of(const StrokePath& path, const WideLine& line, std::size_t begin, std::size_t end) {
    TracedStroke stroke;
    stroke.closed = path.closed && begin == 0 && end == line.points.size();
    stroke.width = line.widths[(begin + end) / 2];
    stroke.points.reserve(end - begin);
    for (std::size_t i = begin; i < end; ++i) {
        TracedPoint& point = stroke.points.emplace_back();
        point.center = line.points[i];
        point.orientation = direction_along(line.points, i);
        point.thickness = line.widths[i];
        point.intensity = path.darkness;
        point.oriented = point.profiled = true;
    }
    return stroke;
}

/// Adds the pieces of a path inside of a mask.
void add_pieces(const StrokePath& path, const PixelMask& mask, std::vector<TracedStroke>& out) {
    constexpr float k_step = 1;  // pixels
    const WideLine line = evenly_spaced(path, k_step);
    const std::vector<Vec2>& points = line.points;
    for (std::size_t begin = 0; begin < points.size(); ++begin) {
        std::size_t end = begin;
        while (end < points.size() && is_inside(mask, points[end])) ++end;
        if (end - begin >= 2) out.push_back(piece_of(path, line, begin, end));
        begin = end;
    }
}

/// Marks the pixels that center lines run through.
PixelMask skeleton_of(std::span<const TracedStroke> strokes, int width, int height) {
    PixelMask skeleton(width, height, 1);
    for (const TracedStroke& stroke : strokes)
        for (const TracedPoint& point : stroke.points)
            skeleton.pixel(static_cast<int>(point.center.x()), static_cast<int>(point.center.y()))[0] = 1;
    return skeleton;
}

}  // namespace

std::vector<HatchStroke> drawn_strokes(std::span<const StrokePath> paths) {
    std::vector<HatchStroke> out;
    out.reserve(paths.size());
    for (const StrokePath& path : paths) {
        WideLine line = evenly_spaced(path, 2);
        out.push_back({0, std::move(line.points), std::move(line.widths), path.darkness});
    }
    return out;
}

KnownDrawing known_drawing(std::span<const StrokePath> paths, const FloatImage& darkness, const PixelMask& mask,
                           float min_darkness) {
    KnownDrawing drawing;
    for (const StrokePath& path : paths)
        if (path.darkness >= min_darkness)
            add_pieces(path, mask, path.outline ? drawing.outlines : drawing.traced.strokes);
    TracedDrawing& traced = drawing.traced;
    traced.skeleton = skeleton_of(traced.strokes, mask.width, mask.height);
    traced.ink = ink_pixels(gaussian_blur(darkness, k_ink_smoothing_of_paths), min_darkness);
    for (std::size_t i = 0; i < traced.ink.data.size(); ++i) traced.ink.data[i] |= traced.skeleton.data[i];
    return drawing;
}

}  // namespace exemplar
