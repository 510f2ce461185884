#include "host/hatching/registration/drawn_lines.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/core/statistics.h"
#include "host/hatching/drawing/placement_loss.h"
#include "host/hatching/fields/hatching_fields.h"
#include "host/hatching/tracing/drawing_filters.h"
#include "host/hatching/tracing/region_outline.h"
#include "host/hatching/tracing/traced_drawing.h"

namespace exemplar {
namespace {

constexpr float k_line_turn = 25 * std::numbers::pi_v<float> / 180;
constexpr float k_outer_reach = 3;  ///< pixels that the border of a region runs beside the line that is drawn there
constexpr double k_outlined = 0.5;  ///< min share of a region's border that is drawn in an outlined drawing

/// The direction of a region's border at a place; none where the distance does not change.
std::optional<float> border_direction(const FloatImage& distance, const Vec2& place) {
    constexpr float k_step = 2;
    const Vec2 out = distance_change(distance, place, k_step);
    if (out.squaredNorm() < 1) return std::nullopt;
    const float angle = std::atan2(out.x(), -out.y());
    return angle < 0 ? angle + std::numbers::pi_v<float> : angle;
}

std::vector<LinePoint> border_line(const PictureRegion& region) {
    std::vector<LinePoint> line;
    for (const Vec2& place : border_points(region.mask, region.mask.data.size()))
        if (const auto along = border_direction(region.distance, place)) line.push_back({place, *along});
    return line;
}

/// Returns the lines that run along a region's border and beside it.
std::vector<LinePoint> outer_lines(const std::vector<LinePoint>& lines, const PictureRegion& region, float width) {
    std::vector<LinePoint> outer;
    for (const LinePoint& point : lines) {
        if (std::abs(distance_at(region.distance, point.place)) > k_outer_reach + 0.5f * width) continue;
        const auto along = border_direction(region.distance, point.place);
        if (along && orientation_difference(*along, point.orientation) < k_line_turn) outer.push_back(point);
    }
    return outer;
}

}  // namespace

LineMap::LineMap(int width, int height, std::vector<LinePoint> points)
    : width_(width), height_(height), points_(std::move(points)) {
    const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    point_of_.assign(pixels, k_no_site);
    for (std::size_t bin = 0; bin < k_bins; ++bin) {
        std::vector<std::uint8_t> on(pixels);
        const float direction = std::numbers::pi_v<float> * static_cast<float>(bin) / k_bins;
        for (std::size_t i = 0; i < points_.size(); ++i) {
            const LinePoint& point = points_[i];
            const int x = static_cast<int>(point.place.x()), y = static_cast<int>(point.place.y());
            if (x < 0 || y < 0 || x >= width || y >= height) continue;
            const std::size_t pixel =
                static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
            if (orientation_difference(direction, point.orientation) > k_line_turn) continue;
            on[pixel] = 1;
            point_of_[pixel] = static_cast<std::int32_t>(i);
        }
        nearest_[bin] = nearest_sites(width, height, on);
    }
}

const LinePoint* LineMap::nearest(const Vec2& place, float orientation) const {
    const int x = static_cast<int>(std::floor(place.x())), y = static_cast<int>(std::floor(place.y()));
    if (x < 0 || y < 0 || x >= width_ || y >= height_) return nullptr;
    const auto bin = static_cast<std::size_t>(std::lround(orientation / std::numbers::pi_v<float> * k_bins)) % k_bins;
    const std::int32_t site =
        nearest_[bin][static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x)];
    if (site == k_no_site) return nullptr;
    return &points_[static_cast<std::size_t>(point_of_[static_cast<std::size_t>(site)])];
}

DrawnLines drawn_lines(const FloatImage& darkness, const PictureRegion& region) {
    const TracedDrawing traced =
        trace_drawing(darkness, PixelMask(darkness.width, darkness.height, 1, 1), k_smoothed_ink_darkness);
    std::vector<LinePoint> lines;
    std::vector<float> widths;
    for (TracedStroke stroke : traced.strokes) {
        orient_along(stroke);
        widths.push_back(stroke.width);
        for (const TracedPoint& point : stroke.points) lines.push_back({point.center, point.orientation});
    }
    std::vector<LinePoint> outer = outer_lines(lines, region, upper_median(widths));
    const std::vector<LinePoint> border = border_line(region);
    DrawnLines drawn{LineMap(darkness.width, darkness.height, std::move(lines)),
                     LineMap(darkness.width, darkness.height, outer), false};
    std::size_t beside = 0;
    for (const LinePoint& point : border) {
        const LinePoint* line = drawn.outer.nearest(point.place, point.orientation);
        beside += line && (line->place - point.place).norm() < 2 * k_outer_reach;
    }
    drawn.outlined = static_cast<double>(beside) >= k_outlined * static_cast<double>(border.size());
    if (!drawn.outlined) drawn.outer = LineMap(darkness.width, darkness.height, border);
    return drawn;
}

}  // namespace exemplar
