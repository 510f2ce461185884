#include "host/hatching/measurement/pen.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "host/core/statistics.h"
#include "host/imaging/bilinear.h"

namespace exemplar {
namespace {

constexpr float k_look = 14, k_look_share = 0.45f;  ///< how far inside an end is looked at: pixels, and of the stroke
constexpr float k_shortest = 20;                    ///< pixels: of strokes whose ends are looked at
constexpr float k_full_share = 0.3f;                ///< of what is looked at: the innermost part, which is whole
constexpr float k_beyond = 5;                       ///< pixels beyond it
constexpr float k_end_step = 0.5f;
constexpr float k_beside = 1.5f;  ///< pixels beside a stroke that its ink may be blurred over
constexpr std::size_t k_min_ends = 20;
/// The area that a taper of one pixel takes from a stroke of unit width, counted from where half the width is left. A
/// taper is a quarter of an ellipse (stroke_taper), so this is the integral of 1 - sqrt(x (2 - x)) from 1 - sqrt(3/4)
/// to 1.
constexpr float k_missing = 0.126f;
constexpr float k_blurred = 0.4f;  ///< what is missing of a blunt end, per standard deviation of its blur

/// The points of a stroke from one of its ends on.
std::vector<TracedPoint> from_end(const TracedStroke& stroke, bool back) {
    std::vector<TracedPoint> points = stroke.points;
    if (back) std::ranges::reverse(points);
    return points;
}

/// The ink across a stroke at a place: darkness above the paper's, summed over the width, pixels.
float ink_across(const FloatImage& darkness, float paper, const Vec2& place, const Vec2& along, float thickness) {
    const Vec2 across(-along.y(), along.x());
    const int reach = static_cast<int>((0.5f * thickness + k_beside) / k_end_step);
    float sum = 0;
    for (int i = -reach; i <= reach; ++i)
        sum += sample_bilinear(darkness, place + k_end_step * static_cast<float>(i) * across, ImageBorder::nearest) -
               paper;
    return k_end_step * std::max(sum, 0.0f);
}

/// The ink across a stroke, step by step from beyond its end to the inside; empty unless the end lies free and the
/// stroke is long.
std::vector<float> ink_at_end(const FloatImage& darkness, float paper, const TracedStroke& stroke, bool back) {
    const std::vector<TracedPoint> points = from_end(stroke, back);
    const float thickness = points[points.size() / 2].thickness, spacing = points[points.size() / 2].spacing;
    const float length = length_along(stroke), look = std::min(k_look, k_look_share * length);
    if (length < k_shortest || thickness <= 0) return {};
    if (spacing > 0 && spacing < thickness + 2 * k_beside) return {};
    const Vec2 out = end_direction(stroke, back);
    std::vector<float> ink;
    for (float s = k_beyond; s > 0; s -= k_end_step)
        ink.push_back(ink_across(darkness, paper, points[0].center + s * out, out, thickness));
    float passed = 0, next = 0;
    for (std::size_t i = 0; i + 1 < points.size() && next < look; ++i) {
        if (points[i].at_crossing) return {};
        const Vec2 way = points[i + 1].center - points[i].center;
        const float step = way.norm();
        for (; next < passed + step && next < look; next += k_end_step)
            ink.push_back(ink_across(darkness, paper, points[i].center + (next - passed) / step * way, Vec2(way / step),
                                     thickness));
        passed += step;
    }
    return next < look ? std::vector<float>{} : ink;
}

/// Returns what is missing of an end, in pixels of a whole stroke, from where half of its ink is left; nothing if it
/// does not end there.
std::optional<float> missing_ink(const std::vector<float>& ink) {
    const float steps_inside = static_cast<float>(ink.size()) - k_beyond / k_end_step;
    const auto full_steps = static_cast<std::ptrdiff_t>(k_full_share * steps_inside);
    std::vector<float> inside(ink.end() - full_steps, ink.end());
    const float full = upper_median(inside);
    if (!(full > 0) || ink[0] > 0.25f * full) return std::nullopt;
    const auto tip = std::ranges::find_if(ink, [&](float value) { return value >= 0.5f * full; });
    float missing = 0;
    for (auto at = tip; at != ink.end() - full_steps; ++at) missing += 1 - *at / full;
    return k_end_step * missing;
}

/// Returns the taper of one end of a stroke by its widths. A quarter of an ellipse has sqrt(3/4) of its width in its
/// middle.
float taper_at_end(const TracedStroke& stroke, bool back) {
    const std::vector<TracedPoint> points = from_end(stroke, back);
    const float look = std::min(k_look, k_look_share * points[0].length);
    std::vector<float> along{0};
    along.reserve(points.size());
    for (std::size_t i = 1; i < points.size() && along.back() < look; ++i)
        along.push_back(along.back() + (points[i].center - points[i - 1].center).norm());
    const float full = std::sqrt(0.75f) * points[along.size() - 1].thickness;
    if (points[0].thickness >= full) return 0;
    for (std::size_t i = 1; i < along.size(); ++i) {
        const float before = points[i - 1].thickness, here = points[i].thickness;
        if (here >= full) return 2 * (along[i - 1] + (full - before) / (here - before) * (along[i] - along[i - 1]));
    }
    return 2 * along.back();
}

}  // namespace

float measure_taper(const FloatImage& darkness, float paper, float softness, std::span<const TracedStroke> strokes) {
    std::vector<float> missing;
    for (const TracedStroke& stroke : strokes)
        for (const bool back : {false, true}) {
            if (stroke.closed) continue;
            const std::vector<float> ink = ink_at_end(darkness, paper, stroke, back);
            if (ink.empty()) continue;
            if (const auto value = missing_ink(ink)) missing.push_back(*value);
        }
    if (missing.size() < k_min_ends) return k_usual_taper;
    const float blunt = k_blurred * std::sqrt(softness * softness + 1.0f / 12);
    return std::max(0.0f, (upper_median(missing) - blunt) / k_missing);
}

float known_taper(std::span<const TracedStroke> strokes) {
    std::vector<float> tapers;
    for (const TracedStroke& stroke : strokes) {
        if (stroke.closed || stroke.points.empty() || stroke.points[0].length < k_shortest) continue;
        for (const bool back : {false, true}) tapers.push_back(taper_at_end(stroke, back));
    }
    return upper_median(tapers);
}

float measure_line_width(const FloatImage& darkness, float paper, std::span<const TracedStroke> lines) {
    std::vector<float> widths;
    for (const TracedStroke& line : lines)
        for (const TracedPoint& point : line.points) {
            const Vec2 along(std::cos(point.orientation), std::sin(point.orientation));
            widths.push_back(ink_across(darkness, paper, point.center, along, line.width));
        }
    return upper_median(widths);
}

}  // namespace exemplar
