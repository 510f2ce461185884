#include "host/hatching/tracing/traced_strokes.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "host/hatching/tracing/stroke_links.h"
#include "host/imaging/bilinear.h"

namespace exemplar {
namespace {

constexpr std::size_t k_min_points = 3;
constexpr std::size_t k_end_points = 4;  ///< points over which darkness and direction at an end are measured
constexpr float k_tip_step = 0.25f;      ///< pixels
constexpr float k_min_aspect = 2;        ///< min points per width; shorter are dots, or remainders of thinning
constexpr float k_min_end_reach = 6, k_max_end_reach = 20;  ///< points over which the direction is measured

/// Builds strokes by walking from segment to segment.
class Assembly {
  public:
    Assembly(const SkeletonGraph& graph, const SegmentLinks& links)
        : graph_(graph), links_(links), used_(graph.segments.size(), false) {}

    std::vector<TracedStroke> run() {
        std::vector<TracedStroke> strokes;
        const auto start_at = [&](std::size_t end) {
            if (used_[end / 2] || links_.shared[end / 2]) return;
            TracedStroke stroke = follow(end);
            if (stroke.points.size() >= k_min_points) strokes.push_back(std::move(stroke));
        };
        for (std::size_t end = 0; end < links_.ends.size(); ++end)
            if (links_.partner[end] == k_unlinked && !graph_.segments[end / 2].closed) start_at(end);
        for (std::size_t end = 0; end < links_.ends.size(); end += 2) start_at(end);
        return strokes;
    }

  private:
    /// Returns the stroke that enters a segment at `entry`.
    TracedStroke follow(std::size_t entry) {
        const std::size_t start = entry;
        std::size_t longest = 0;
        TracedStroke stroke;
        while (true) {
            used_[entry / 2] = true;
            append(entry, stroke);
            if (const std::size_t size = graph_.segments[entry / 2].pixels.size(); size > longest)
                longest = size, stroke.width = links_.ends[entry].width;
            const std::size_t exit = entry ^ 1u, next = links_.partner[exit];
            if (next == k_unlinked || used_[next / 2]) {
                stroke.closed = next == start || graph_.segments[entry / 2].closed;
                if (next == start) bridge(stroke.points.back().center, stroke.points.front().center, stroke);
                return stroke;
            }
            bridge(links_.ends[exit].position, links_.ends[next].position, stroke);
            entry = next;
        }
    }

    void append(std::size_t entry, TracedStroke& stroke) const {
        const SkeletonSegment& segment = graph_.segments[entry / 2];
        const std::size_t exit = entry ^ 1u, last = segment.pixels.size() - 1;
        const std::size_t from = trim(entry), to = last - trim(exit);
        for (std::size_t i = from; i <= to; ++i) {
            TracedPoint point;
            point.center = center_of(segment.pixels[entry % 2 == 0 ? i : last - i]);
            stroke.points.push_back(point);
        }
    }

    std::size_t trim(std::size_t end) const { return links_.partner[end] == k_unlinked ? 0 : links_.ends[end].trim; }

    /// Adds points a pixel apart between two ends.
    static void bridge(const Vec2& from, const Vec2& to, TracedStroke& stroke) {
        const auto steps = static_cast<int>(std::lround((to - from).norm()));
        for (int k = 1; k < steps; ++k) {
            TracedPoint point;
            point.center = from + (to - from) * (static_cast<float>(k) / static_cast<float>(steps));
            point.at_crossing = true;
            stroke.points.push_back(point);
        }
    }

    const SkeletonGraph& graph_;
    const SegmentLinks& links_;
    std::vector<bool> used_;
};

/// Replaces the last points at an end, which thinning bends, by the line fitted to the points before them.
void straighten_end(std::span<TracedPoint> inward, float width) {
    const auto bent = static_cast<std::size_t>(std::lround(0.5f * width)) + 1;
    const auto shown = static_cast<std::size_t>(std::lround(std::max(k_min_end_reach, 2 * width)));
    if (inward.size() < bent + shown) return;
    const std::span<const TracedPoint> straight = inward.subspan(bent, shown);
    Vec2 middle = Vec2::Zero(), slope = Vec2::Zero();
    const float center = 0.5f * static_cast<float>(shown - 1);
    float squares = 0;
    for (std::size_t i = 0; i < shown; ++i) {
        const float k = static_cast<float>(i) - center;
        middle += straight[i].center / static_cast<float>(shown);
        slope += k * straight[i].center;
        squares += k * k;
    }
    for (std::size_t i = 0; i < bent; ++i)
        inward[i].center = middle + slope * ((static_cast<float>(i) - static_cast<float>(bent) - center) / squares);
}

void straighten_ends(TracedStroke& stroke) {
    if (stroke.closed) return;
    straighten_end(stroke.points, stroke.width);
    std::reverse(stroke.points.begin(), stroke.points.end());
    straighten_end(stroke.points, stroke.width);
    std::reverse(stroke.points.begin(), stroke.points.end());
}

/// Whether a stroke is shorter than twice its greatest width between crossings.
bool is_dot(const TracedStroke& stroke, const FloatImage& width) {
    float widest = stroke.width;
    for (const TracedPoint& point : stroke.points) {
        const int x = static_cast<int>(point.center.x()), y = static_cast<int>(point.center.y());
        if (!point.at_crossing) widest = std::max(widest, width.pixel(x, y)[0]);
    }
    return static_cast<float>(stroke.points.size()) < k_min_aspect * widest;
}

/// Returns point i of a stroke, counted from its front or back, or the last one.
const TracedPoint& point_from(const TracedStroke& stroke, bool back, std::size_t i) {
    const std::size_t last = stroke.points.size() - 1;
    return stroke.points[back ? last - std::min(i, last) : std::min(i, last)];
}

}  // namespace

std::vector<TracedStroke> trace_strokes(const PixelMask& skeleton, const FloatImage& width, const FloatImage& darkness,
                                        float min_darkness) {
    const SkeletonGraph graph = skeleton_graph(skeleton);
    const SegmentLinks links = link_segments(graph, width, darkness, min_darkness);
    std::vector<TracedStroke> strokes = Assembly(graph, links).run();
    std::erase_if(strokes, [&](const TracedStroke& stroke) { return is_dot(stroke, width); });
    for (TracedStroke& stroke : strokes) {
        straighten_ends(stroke);
        orient_along(stroke);
    }
    return strokes;
}

void orient_along(TracedStroke& stroke) {
    const auto count = static_cast<std::ptrdiff_t>(stroke.points.size());
    const auto reach = static_cast<std::ptrdiff_t>(std::clamp(2 * stroke.width, k_min_end_reach, k_max_end_reach));
    for (std::ptrdiff_t i = 0; i < count; ++i) {
        if (stroke.points[i].oriented) continue;
        // The slope of the least-squares line through the points around, as many on either side.
        std::ptrdiff_t side = std::min(reach, (count - 1) / 2);
        if (!stroke.closed) side = std::min(side, std::max(side / 2, std::min(i, count - 1 - i)));
        Vec2 slope = Vec2::Zero();
        for (std::ptrdiff_t k = -side; k <= side; ++k) {
            const std::ptrdiff_t at =
                stroke.closed ? (i + k + count) % count : std::clamp<std::ptrdiff_t>(i + k, 0, count - 1);
            slope += static_cast<float>(k) * stroke.points[at].center;
        }
        const float angle = std::atan2(slope.y(), slope.x());
        stroke.points[i].orientation =
            angle < 0 ? angle + std::numbers::pi_v<float> : (angle < std::numbers::pi_v<float> ? angle : 0);
    }
}

Vec2 end_direction(const TracedStroke& stroke, bool back) {
    const TracedPoint &end = point_from(stroke, back, 0), &inward = point_from(stroke, back, k_end_points);
    const Vec2 along(std::cos(inward.orientation), std::sin(inward.orientation));
    return along.dot(end.center - inward.center) < 0 ? Vec2(-along) : along;
}

std::optional<float> distance_to_tip(const FloatImage& darkness, const TracedStroke& stroke, bool back, float width) {
    const Vec2 out = end_direction(stroke, back), end = point_from(stroke, back, 0).center;
    const auto darkness_at = [&](const Vec2& place) { return sample_bilinear(darkness, place, ImageBorder::nearest); };
    float dark = 0;
    for (std::size_t i = 1; i <= k_end_points; ++i)
        dark = std::max(dark, darkness_at(point_from(stroke, back, i).center));
    for (float way = -0.5f * width; way < 2 * width + 3; way += k_tip_step)
        if (darkness_at(end + way * out) < 0.5f * dark) return way - 0.5f * k_tip_step;
    return std::nullopt;
}

float length_along(const TracedStroke& stroke) {
    const std::vector<TracedPoint>& points = stroke.points;
    const auto step = [](const TracedPoint& a, const TracedPoint& b) {
        const Vec2 way = b.center - a.center;
        const auto along = [&](float angle) { return std::abs(way.x() * std::cos(angle) + way.y() * std::sin(angle)); };
        return 0.5f * (along(a.orientation) + along(b.orientation));
    };
    float length = stroke.closed ? step(points.back(), points.front()) : 0;
    for (std::size_t i = 0; i + 1 < points.size(); ++i) length += step(points[i], points[i + 1]);
    return length;
}

}  // namespace exemplar
