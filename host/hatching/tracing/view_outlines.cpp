#include "host/hatching/tracing/view_outlines.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <utility>

#include "host/hatching/fields/hatching_fields.h"
#include "host/hatching/fields/occlusion_barriers.h"
#include "host/hatching/tracing/drawing_filters.h"

namespace exemplar {
namespace {

constexpr int k_outline_window = 5;  ///< pixels to either side over which an outline's direction is fitted
constexpr float k_max_outline_turn = std::numbers::pi_v<float> / 6;
constexpr double k_min_drawn = 0.5;  ///< min share of the view's outlines that a drawing with outlines follows

/// Marks the nearer pixel of each occlusion boundary.
std::vector<std::uint8_t> outline_pixels(const GBuffer& gbuffer) {
    const std::vector<std::uint8_t> barriers = occlusion_barriers(gbuffer.depth, gbuffer.width, gbuffer.height);
    std::vector<std::uint8_t> on(barriers.size());
    const auto mark = [&](std::size_t a, std::size_t b) { on[gbuffer.depth[a] <= gbuffer.depth[b] ? a : b] = 1; };
    for (std::size_t i = 0; i < barriers.size(); ++i) {
        if (barriers[i] & k_barrier_right) mark(i, i + 1);
        if (barriers[i] & k_barrier_below) mark(i, i + static_cast<std::size_t>(gbuffer.width));
    }
    return on;
}

/// Returns the direction of the line through the marked pixels around a pixel: the first axis of their covariance.
float direction_at(const std::vector<std::uint8_t>& on, int width, int height, int x, int y) {
    double count = 0, sx = 0, sy = 0, xx = 0, xy = 0, yy = 0;
    for (int v = std::max(0, y - k_outline_window); v <= std::min(height - 1, y + k_outline_window); ++v)
        for (int u = std::max(0, x - k_outline_window); u <= std::min(width - 1, x + k_outline_window); ++u) {
            if (!on[static_cast<std::size_t>(v) * static_cast<std::size_t>(width) + static_cast<std::size_t>(u)])
                continue;
            const double dx = u - x, dy = v - y;
            count += 1, sx += dx, sy += dy, xx += dx * dx, xy += dx * dy, yy += dy * dy;
        }
    xx -= sx * sx / count, xy -= sx * sy / count, yy -= sy * sy / count;
    const auto angle = static_cast<float>(0.5 * std::atan2(2 * xy, xx - yy));
    return angle < 0 ? angle + std::numbers::pi_v<float> : angle;
}

/// Whether each point of a stroke belongs to an outline.
std::vector<bool> follows_outline(const TracedStroke& stroke, const ViewOutlines& outlines, float reach) {
    std::vector<bool> follows;
    for (const TracedPoint& point : stroke.points) {
        const int x = std::clamp(static_cast<int>(point.center.x()), 0, outlines.width - 1);
        const int y = std::clamp(static_cast<int>(point.center.y()), 0, outlines.height - 1);
        const auto pixel =
            static_cast<std::size_t>(y) * static_cast<std::size_t>(outlines.width) + static_cast<std::size_t>(x);
        const float distance = outlines.distance(pixel);
        follows.push_back(
            distance <= reach &&
            orientation_difference(point.orientation,
                                   outlines.direction[static_cast<std::size_t>(outlines.nearest[pixel])]) <=
                k_max_outline_turn);
    }
    return follows;
}

/// Runs of equal values: pairs of their first and last-but-one index.
std::vector<std::pair<std::size_t, std::size_t>> runs_of(const std::vector<bool>& values) {
    std::vector<std::pair<std::size_t, std::size_t>> runs;
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (i == 0 || values[i] != values[i - 1]) runs.emplace_back(i, i);
        runs.back().second = i + 1;
    }
    return runs;
}

/// Sets runs shorter than `least` points to the value around them: first parts that briefly run along an outline,
/// then short remainders.
void drop_short_runs(std::vector<bool>& follows, std::size_t least) {
    for (const bool value : {true, false})
        for (const auto& [begin, end] : runs_of(follows))
            if (follows[begin] == value && end - begin < least && end - begin < follows.size())
                std::fill(follows.begin() + static_cast<std::ptrdiff_t>(begin),
                          follows.begin() + static_cast<std::ptrdiff_t>(end), !value);
}

TracedStroke part_of(const TracedStroke& stroke, std::size_t begin, std::size_t end) {
    TracedStroke part;
    part.closed = stroke.closed && end - begin == stroke.points.size();
    part.width = stroke.width;
    part.points.assign(stroke.points.begin() + static_cast<std::ptrdiff_t>(begin),
                       stroke.points.begin() + static_cast<std::ptrdiff_t>(end));
    return part;
}

}  // namespace

float ViewOutlines::distance(std::size_t pixel) const {
    const std::int32_t site = nearest[pixel];
    return site == k_no_site ? std::numeric_limits<float>::infinity()
                             : pixel_distance(static_cast<std::int32_t>(pixel), site, width);
}

ViewOutlines view_outlines(const GBuffer& gbuffer) {
    const std::vector<std::uint8_t> on = outline_pixels(gbuffer);
    ViewOutlines outlines{gbuffer.width, gbuffer.height, 0, nearest_sites(gbuffer.width, gbuffer.height, on),
                          std::vector<float>(on.size())};
    for (int y = 0; y < gbuffer.height; ++y)
        for (int x = 0; x < gbuffer.width; ++x) {
            const std::size_t i = gbuffer.index(x, y);
            if (!on[i]) continue;
            ++outlines.count;
            outlines.direction[i] = direction_at(on, gbuffer.width, gbuffer.height, x, y);
        }
    return outlines;
}

std::vector<TracedStroke> take_outlines(std::vector<TracedStroke>& strokes, const ViewOutlines& outlines, float reach) {
    constexpr std::size_t k_min_points = 3;
    const auto least = std::max(k_min_points, static_cast<std::size_t>(std::lround(reach)));
    std::vector<TracedStroke> drawn, rest;
    std::size_t length = 0;
    for (const TracedStroke& stroke : strokes) {
        std::vector<bool> follows = follows_outline(stroke, outlines, reach);
        drop_short_runs(follows, least);
        for (const auto& [begin, end] : runs_of(follows)) {
            if (end - begin < k_min_points) continue;
            if (follows[begin]) length += end - begin;
            (follows[begin] ? drawn : rest).push_back(part_of(stroke, begin, end));
        }
    }
    if (static_cast<double>(length) < k_min_drawn * static_cast<double>(outlines.count)) return {};
    strokes = std::move(rest);
    return drawn;
}

}  // namespace exemplar
