#include "host/hatching/placement/clipped_strokes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "host/core/errors.h"
#include "host/hatching/placement/streamline_steps.h"
#include "host/hatching/placement/stroke_directions.h"
#include "host/hatching/placement/stroke_growth.h"

namespace exemplar {
namespace {

/// Coordinates are clamped to this magnitude; farther outside of the picture, position makes no difference.
constexpr float k_farthest = 65536;

FinePoint fine_point(const Vec2& point) {
    const auto fine = [](float value) {
        return static_cast<std::int32_t>(std::floor(std::clamp(value, -k_farthest, k_farthest) * k_pixel));
    };
    return {fine(point.x()), fine(point.y())};
}

void check_kept_stroke(const HatchStroke& stroke) {
    if (stroke.layer >= k_hatch_layers)
        throw UsageError(fmt::format("a kept stroke is of layer {}; there are 0 and 1", stroke.layer));
    for (const Vec2& point : stroke.points)
        if (!point.allFinite())
            throw UsageError(
                fmt::format("a kept stroke has the point ({}, {}); points are finite", point.x(), point.y()));
}

/// Resamples a polyline in steps of k_step from its first point on; a remainder shorter than a step is dropped. At
/// most `most` points, which bounds the time for lines that lie far outside of the picture.
std::vector<FinePoint> in_steps(const std::vector<Vec2>& line, std::size_t most) {
    std::vector<FinePoint> points;
    constexpr float k_step_pixels = static_cast<float>(k_step) / k_pixel;
    float along = 0;  // arc length from point i of the line to the next sample
    for (std::size_t i = 0; i + 1 < line.size() && points.size() < most; ++i) {
        const Vec2 way = line[i + 1] - line[i];
        const float size = way.norm();
        for (; along <= size && size > 0 && points.size() < most; along += k_step_pixels)
            points.push_back(fine_point(line[i] + along / size * way));
        along -= size;
    }
    return points;
}

/// A part of a stroke: points [begin, end), and how many of its ends are cut off by other strokes.
struct StrokePart {
    std::size_t begin = 0, end = 0;
    std::int32_t crowded_ends = 0;
    std::size_t size() const { return end - begin; }
};

class StrokeClipper {
  public:
    StrokeClipper(const PlacementGrid& grid, const StrokeOptions& options, Clearance& clearance)
        : grid_(grid),
          clearance_(clearance),
          min_cosine_(static_cast<std::int32_t>(std::lround(std::cos(options.max_deviation) * k_unit))),
          max_share_(static_cast<std::int64_t>(
              std::lround((1.0 + options.length_jitter + options.length_hysteresis) * (1 << k_share_bits)))) {}

    /// Returns the clipped stroke; empty if it is too short.
    FineStroke keep(const HatchStroke& stroke) const {
        FineStroke kept{.layer = static_cast<std::uint32_t>(stroke.layer), .points = {}};
        const auto most = 4 * static_cast<std::size_t>(grid_.width + grid_.height);
        const std::vector<FinePoint> points = in_steps(stroke.points, most);
        const StrokePart part = cut(points, longest_part(kept.layer, points));
        if (part.size() < 2) return kept;
        const PlacementTexel& middle = *grid_.at(points[(part.begin + part.end) / 2]);
        if (static_cast<std::int32_t>(part.size()) - 1 < min_stroke_steps(grid_, middle, part.crowded_ends))
            return kept;
        kept.points.assign(points.begin() + static_cast<std::ptrdiff_t>(part.begin),
                           points.begin() + static_cast<std::ptrdiff_t>(part.end));
        return kept;
    }

  private:
    bool is_in_place(std::uint32_t layer, const std::vector<FinePoint>& points, std::size_t i) const {
        const FinePoint way = points[std::min(i + 1, points.size() - 1)] - points[i ? i - 1 : 0];
        const Direction heading = direction_of(way.x, way.y);
        const Direction asked = direction_at(grid_, layer, points[i], heading);
        return asked && dot(asked, heading) >= min_cosine_ * k_unit;
    }
    bool is_clear(std::uint32_t layer, FinePoint point) const {
        return clearance_.is_clear(layer, point, grid_.at(point)->spacing(), grid_.rules.test_share);
    }

    StrokePart longest_part(std::uint32_t layer, const std::vector<FinePoint>& points) const {
        StrokePart longest, part;
        const auto finish = [&](std::size_t next, bool is_crowded) {
            part.crowded_ends += is_crowded ? 1 : 0;
            if (part.size() > longest.size()) longest = part;
            part = {next, next, is_crowded ? 1 : 0};
        };
        for (std::size_t i = 0; i < points.size(); ++i) {
            const bool in_place = is_in_place(layer, points, i);
            if (!in_place || !is_clear(layer, points[i])) {
                finish(i + 1, in_place);
                continue;
            }
            if (part.size() > 0 && !is_free_step(grid_, points[i - 1], points[i])) finish(i, false);
            part.end = i + 1;
        }
        finish(points.size(), false);
        return longest;
    }

    /// Trims a part that is too long to its target length, around the same middle.
    StrokePart cut(const std::vector<FinePoint>& points, StrokePart part) const {
        if (part.size() == 0) return part;
        const std::int64_t target = grid_.at(points[(part.begin + part.end) / 2])->length() >> k_length_bits;
        const auto steps = static_cast<std::int64_t>(part.size() - 1);
        if (steps << k_share_bits <= target * max_share_) return part;
        const auto over = static_cast<std::size_t>(steps - target);
        return {part.begin + over / 2, part.end - (over - over / 2), part.crowded_ends};
    }

    const PlacementGrid& grid_;
    const Clearance& clearance_;
    std::int32_t min_cosine_;
    std::int64_t max_share_;
};

}  // namespace

std::vector<FineStroke> clip_strokes(const PlacementGrid& grid, std::span<const HatchStroke> strokes,
                                     const StrokeOptions& options, Clearance& clearance) {
    const StrokeClipper keeper(grid, options, clearance);
    std::vector<FineStroke> kept;
    for (const HatchStroke& stroke : strokes) {
        check_kept_stroke(stroke);
        FineStroke part = keeper.keep(stroke);
        if (part.points.empty()) continue;
        clearance.add(part);
        kept.push_back(std::move(part));
    }
    grow_strokes(grid, kept);
    for (const FineStroke& stroke : kept) clearance.add(stroke);
    return kept;
}

}  // namespace exemplar
