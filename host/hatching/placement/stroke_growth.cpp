#include "host/hatching/placement/stroke_growth.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <vector>

#include "host/hatching/placement/streamline_steps.h"

namespace exemplar {
namespace {

/// The points of strokes in square cells of the picture.
class StrokePoints {
  public:
    struct Entry {
        FinePoint point;
        std::size_t stroke = 0;
        std::int32_t place = 0;  ///< along the stroke
    };

    explicit StrokePoints(const PlacementGrid& grid)
        : columns_((grid.width >> k_cell_bits) + 1), rows_((grid.height >> k_cell_bits) + 1) {
        for (auto& cells : cells_) cells.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
    }
    void add(std::uint32_t layer, const Entry& entry) {
        cells_[layer][index(cell(entry.point.x), cell(entry.point.y))].push_back(entry);
    }
    /// Returns whether a point with counts(entry) is within a distance.
    template <typename Counts>
    bool any_within(std::uint32_t layer, FinePoint point, std::int32_t distance, Counts&& counts) const {
        const std::int64_t square = std::int64_t{distance} * distance;
        const auto is_near = [&](const Entry& entry) {
            const std::int64_t x = entry.point.x - point.x, y = entry.point.y - point.y;
            return x * x + y * y < square && counts(entry);
        };
        const int right = std::min(cell(point.x + distance), columns_ - 1);
        const int bottom = std::min(cell(point.y + distance), rows_ - 1);
        for (int y = std::max(cell(point.y - distance), 0); y <= bottom; ++y)
            for (int x = std::max(cell(point.x - distance), 0); x <= right; ++x)
                if (std::ranges::any_of(cells_[layer][index(x, y)], is_near)) return true;
        return false;
    }

  private:
    static constexpr int k_cell_bits = 3;  // 8 pixels
    static int cell(std::int32_t x) { return x >> (k_pixel_bits + k_cell_bits); }
    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(x);
    }
    int columns_, rows_;
    std::array<std::vector<std::vector<Entry>>, k_hatch_layers> cells_;
};

class Grower {
  public:
    Grower(const PlacementGrid& grid, std::span<FineStroke> strokes) : grid_(grid), strokes_(strokes), points_(grid) {
        for (std::size_t s = 0; s < strokes.size(); ++s) {
            for (std::size_t i = 0; i < strokes[s].points.size(); ++i)
                points_.add(strokes[s].layer, {strokes[s].points[i], s, static_cast<std::int32_t>(i)});
        }
    }

    void grow(std::size_t s) {
        std::vector<FinePoint>& points = strokes_[s].points;
        const auto last = static_cast<std::int32_t>(points.size()) - 1;
        grow_end(s, last, 1);
        std::ranges::reverse(points);
        grow_end(s, 0, -1);
        std::ranges::reverse(points);
    }

  private:
    /// Extends the end at the back of the points. That point has the index `place` along the stroke; indices of new
    /// points go on in steps of `by`.
    void grow_end(std::size_t s, std::int32_t place, std::int32_t by) {
        std::vector<FinePoint>& points = strokes_[s].points;
        const FinePoint way = points.back() - points[points.size() - 2];
        Direction heading = direction_of(way.x, way.y);
        while (is_short(points)) {
            const auto next = next_step(grid_, strokes_[s].layer, points.back(), heading);
            place += by;
            if (!next || is_crowded(s, place, next->point)) return;
            heading = next->heading;
            points.push_back(next->point);
            points_.add(strokes_[s].layer, {next->point, s, place});
        }
    }

    bool is_short(const std::vector<FinePoint>& points) const {
        const std::int32_t share = (1 << k_share_bits) - grid_.rules.jitter;
        return static_cast<std::int32_t>(points.size()) - 1 < Streamline::target_steps(*grid_.at(points.back()), share);
    }

    bool is_crowded(std::size_t s, std::int32_t place, FinePoint point) const {
        const std::int32_t test = share_of_spacing(grid_.at(point)->spacing(), grid_.rules.test_share);
        const std::int32_t along = 2 * (test >> k_pixel_bits) + 1;
        return points_.any_within(strokes_[s].layer, point, test, [&](const StrokePoints::Entry& entry) {
            return entry.stroke != s || std::abs(entry.place - place) > along;
        });
    }

    const PlacementGrid& grid_;
    std::span<FineStroke> strokes_;
    StrokePoints points_;
};

}  // namespace

void grow_strokes(const PlacementGrid& grid, std::span<FineStroke> strokes) {
    Grower grower(grid, strokes);
    for (std::size_t s = 0; s < strokes.size(); ++s) grower.grow(s);
}

}  // namespace exemplar
