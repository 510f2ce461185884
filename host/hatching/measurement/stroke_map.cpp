#include "host/hatching/measurement/stroke_map.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "host/core/parallel.h"
#include "host/hatching/fields/hatching_fields.h"
#include "host/hatching/tracing/drawing_filters.h"

namespace exemplar {
namespace {

constexpr int k_meeting_reach = 2;           ///< max distance between the center lines of strokes that meet, pixels
constexpr std::int32_t k_max_point_gap = 4;  ///< max gap within one crossing of two strokes, points
constexpr float k_ink_edge = 1;              ///< pixels by which ink reaches beyond its width
constexpr float k_widest_overlap = 4;        ///< max radius of crossings at small angles, in widths

Pixel pixel_within(const Vec2& at, int width, int height) {
    return {std::clamp(static_cast<int>(std::floor(at.x())), 0, width - 1),
            std::clamp(static_cast<int>(std::floor(at.y())), 0, height - 1)};
}

/// Two points of different strokes that are near each other.
struct Meeting {
    std::int32_t first_stroke, second_stroke, first_point, second_point;
    auto key() const { return std::tie(first_stroke, second_stroke, first_point, second_point); }
    bool operator<(const Meeting& other) const { return key() < other.key(); }
};

/// The points in each pixel.
class PointGrid {
  public:
    PointGrid(std::span<const TracedStroke> strokes, int width, int height) : width_(width), height_(height) {
        start_.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) + 1, 0);
        visit(strokes, [&](std::size_t pixel, PointId) { ++start_[pixel + 1]; });
        for (std::size_t i = 1; i < start_.size(); ++i) start_[i] += start_[i - 1];
        points_.resize(start_.back());
        std::vector<std::uint32_t> next(start_.begin(), start_.end() - 1);
        visit(strokes, [&](std::size_t pixel, PointId id) { points_[next[pixel]++] = id; });
    }

    std::span<const PointId> at(int x, int y) const {
        if (x < 0 || y < 0 || x >= width_ || y >= height_) return {};
        const std::size_t i = static_cast<std::size_t>(y) * width_ + x;
        return std::span(points_).subspan(start_[i], start_[i + 1] - start_[i]);
    }

  private:
    template <typename Body>
    void visit(std::span<const TracedStroke> strokes, Body body) const {
        for (std::size_t s = 0; s < strokes.size(); ++s)
            for (std::size_t p = 0; p < strokes[s].points.size(); ++p) {
                const Pixel at = pixel_within(strokes[s].points[p].center, width_, height_);
                body(static_cast<std::size_t>(at[1]) * width_ + at[0],
                     PointId{static_cast<std::int32_t>(s), static_cast<std::int32_t>(p)});
            }
    }

    int width_, height_;
    std::vector<std::uint32_t> start_;
    std::vector<PointId> points_;
};

void find_meetings(std::span<const TracedStroke> strokes, std::int32_t stroke, const PointGrid& grid, float min_angle,
                   std::vector<Meeting>& out) {
    for (std::size_t p = 0; p < strokes[stroke].points.size(); ++p) {
        const TracedPoint& point = strokes[stroke].points[p];
        const int x = static_cast<int>(std::floor(point.center.x())),
                  y = static_cast<int>(std::floor(point.center.y()));
        for (int dy = -k_meeting_reach; dy <= k_meeting_reach; ++dy)
            for (int dx = -k_meeting_reach; dx <= k_meeting_reach; ++dx)
                for (const PointId& other : grid.at(x + dx, y + dy)) {
                    if (other.stroke <= stroke) continue;
                    const TracedPoint& second = strokes[other.stroke].points[other.point];
                    if ((second.center - point.center).norm() <= k_meeting_reach &&
                        orientation_difference(second.orientation, point.orientation) >= min_angle)
                        out.push_back({stroke, other.stroke, static_cast<std::int32_t>(p), other.point});
                }
    }
}

/// Returns the mean unsigned direction of some points.
template <typename Range, typename PointOf>
Vec2 mean_direction(const Range& range, PointOf point_of) {
    Vec2 doubled = Vec2::Zero();
    for (const auto& item : range) {
        const float angle = 2 * point_of(item).orientation;
        doubled += Vec2(std::cos(angle), std::sin(angle));
    }
    const float angle = 0.5f * std::atan2(doubled.y(), doubled.x());
    return {std::cos(angle), std::sin(angle)};
}

StrokeCrossing crossing_of(std::span<const Meeting> meetings, std::span<const TracedStroke> strokes) {
    const TracedStroke &first = strokes[meetings[0].first_stroke], &second = strokes[meetings[0].second_stroke];
    const auto on_first = [&](const Meeting& m) -> const TracedPoint& { return first.points[m.first_point]; };
    const auto on_second = [&](const Meeting& m) -> const TracedPoint& { return second.points[m.second_point]; };
    StrokeCrossing crossing;
    for (const Meeting& m : meetings) crossing.center += 0.5f * (on_first(m).center + on_second(m).center);
    crossing.center /= static_cast<float>(meetings.size());
    crossing.strokes = {meetings[0].first_stroke, meetings[0].second_stroke};
    crossing.directions = {mean_direction(meetings, on_first), mean_direction(meetings, on_second)};
    crossing.widths = {first.width, second.width};
    return crossing;
}

float cross_product(const Vec2& a, const Vec2& b) {
    return a.x() * b.y() - a.y() * b.x();
}

}  // namespace

StrokeMap::StrokeMap(std::span<const TracedStroke> strokes, int width, int height)
    : width_(width), height_(height), owner_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height)) {
    std::vector<std::uint8_t> is_site(owner_.size(), 0);
    for (std::size_t s = 0; s < strokes.size(); ++s)
        for (std::size_t p = 0; p < strokes[s].points.size(); ++p) {
            const auto [x, y] = pixel_of(strokes[s].points[p]);
            const std::size_t i = index(x, y);
            if (is_site[i]) continue;
            is_site[i] = 1;
            owner_[i] = {static_cast<std::int32_t>(s), static_cast<std::int32_t>(p)};
            empty_ = false;
        }
    nearest_ = nearest_sites(width, height, is_site);
    if (empty_) std::fill(nearest_.begin(), nearest_.end(), 0);
}

float StrokeMap::distance(int x, int y) const {
    return pixel_distance(nearest_[index(x, y)], static_cast<std::int32_t>(index(x, y)), width_);
}

Pixel StrokeMap::pixel_of(const TracedPoint& point) const {
    return pixel_within(point.center, width_, height_);
}

std::vector<StrokeCrossing> find_crossings(std::span<const TracedStroke> strokes, int width, int height,
                                           float min_angle) {
    const PointGrid grid(strokes, width, height);
    std::vector<Meeting> meetings;
    for (std::size_t s = 0; s < strokes.size(); ++s)
        find_meetings(strokes, static_cast<std::int32_t>(s), grid, min_angle, meetings);
    std::sort(meetings.begin(), meetings.end());
    std::vector<StrokeCrossing> crossings;
    for (std::size_t begin = 0, end = 0; begin < meetings.size(); begin = end) {
        const auto belongs = [&](const Meeting& m, const Meeting& before) {
            return m.first_stroke == before.first_stroke && m.second_stroke == before.second_stroke &&
                   m.first_point - before.first_point <= k_max_point_gap;
        };
        for (end = begin + 1; end < meetings.size() && belongs(meetings[end], meetings[end - 1]);) ++end;
        crossings.push_back(crossing_of(std::span(meetings).subspan(begin, end - begin), strokes));
    }
    return crossings;
}

float StrokeCrossing::radius() const {
    const float widest = std::max(widths[0], widths[1]) + 2 * k_ink_edge;
    const float sine = std::abs(cross_product(directions[0], directions[1]));
    const float cosine = std::abs(directions[0].dot(directions[1]));
    return std::min(0.5f * widest * std::sqrt(2 * (1 + cosine)) / sine, k_widest_overlap * widest);
}

bool StrokeCrossing::covers(const Vec2& place) const {
    const Vec2 way = place - center;
    for (const std::size_t k : {0u, 1u})
        if (std::abs(cross_product(directions[k], way)) > 0.5f * widths[k] + k_ink_edge) return false;
    return way.norm() <= radius();
}

PixelMask crossing_pixels(std::span<const StrokeCrossing> crossings, int width, int height) {
    PixelMask mask(width, height, 1);
    for (const StrokeCrossing& crossing : crossings) {
        const Vec2 reach = Vec2::Constant(crossing.radius());
        const auto [left, top] = pixel_within(crossing.center - reach, width, height);
        const auto [right, bottom] = pixel_within(crossing.center + reach, width, height);
        for (int y = top; y <= bottom; ++y)
            for (int x = left; x <= right; ++x)
                if (crossing.covers(center_of({x, y}))) mask.pixel(x, y)[0] = 1;
    }
    return mask;
}

void mark_crossings(const PixelMask& crossing_pixels, std::span<TracedStroke> strokes) {
    for (TracedStroke& stroke : strokes)
        for (TracedPoint& point : stroke.points) {
            const auto [x, y] = pixel_within(point.center, crossing_pixels.width, crossing_pixels.height);
            point.at_crossing = point.at_crossing || crossing_pixels.pixel(x, y)[0];
        }
}

}  // namespace exemplar
