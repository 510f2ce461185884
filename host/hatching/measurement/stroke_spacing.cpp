#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "host/core/parallel.h"
#include "host/hatching/fields/hatching_fields.h"
#include "host/hatching/measurement/along_stroke.h"
#include "host/hatching/measurement/point_cells.h"
#include "host/hatching/measurement/stroke_properties.h"

namespace exemplar {
namespace {

constexpr float k_spacing_cell = 8;       ///< pixels
constexpr float k_farthest_side = 1.75f;  ///< max ratio of the farther to the nearer side for both to count
constexpr float k_farthest_mutual = 2;    ///< max distance of a neighbor, in its own spacings
constexpr std::int32_t k_line_side = 3;   ///< points before and behind another that define its line
constexpr float k_min_loop_ratio = 4;     ///< min ratio of arc length to distance for a stroke to neighbor itself

/// Looks up whether two strokes cross.
class CrossingPairs {
  public:
    CrossingPairs(std::span<const StrokeCrossing> crossings, std::size_t strokes) : crossed_(strokes) {
        for (const StrokeCrossing& c : crossings)
            for (const std::size_t k : {0u, 1u}) crossed_[c.strokes[k]].push_back(c.strokes[1 - k]);
        for (std::vector<std::int32_t>& list : crossed_) std::sort(list.begin(), list.end());
    }
    bool cross(std::int32_t first, std::int32_t second) const {
        return std::binary_search(crossed_[first].begin(), crossed_[first].end(), second);
    }

  private:
    std::vector<std::vector<std::int32_t>> crossed_;
};

/// The nearest point of a neighboring stroke on one side.
struct Neighbor {
    PointId id;
    float distance;    ///< to the point
    float across = 0;  ///< to its line; 0: no neighbor
};

/// The neighbors of a point on its two sides.
struct Neighbors {
    std::array<Neighbor, 2> side;
    explicit Neighbors(float largest) : side{Neighbor{{}, largest}, Neighbor{{}, largest}} {}

    /// Beyond this distance nothing would change the spacing.
    float reach() const {
        const auto [least, most] = std::minmax(side[0].distance, side[1].distance);
        return std::min(most, 2 * least);
    }
    float spacing() const {
        const auto [least, most] = std::minmax(side[0].across, side[1].across);
        if (least == 0) return most;
        return most <= k_farthest_side * least ? 0.5f * (least + most) : least;
    }
};

/// Searches the neighbors on both sides: the nearest alone is nearer than strokes are apart on average. The thesis
/// grows a circle until pixels in it are not connected; but cross-hatches connect everything.
class SpacingSearch {
  public:
    SpacingSearch(std::span<const StrokeCrossing> crossings, float similar, float largest,
                  std::span<const TracedStroke> strokes)
        : strokes_(strokes),
          crossing_(crossings, strokes.size()),
          cells_(strokes, k_spacing_cell),
          similar_(similar),
          largest_(largest) {}

    Neighbors neighbors_of(PointId id) const {
        const TracedPoint& point = strokes_[id.stroke].points[id.point];
        const int column = cells_.column(point.center.x()), row = cells_.row(point.center.y());
        Neighbors neighbors(largest_);
        for (int ring = 0; static_cast<float>(ring - 1) * k_spacing_cell < neighbors.reach(); ++ring)
            for (int r = row - ring; r <= row + ring; ++r) {
                const bool edge = r == row - ring || r == row + ring;
                for (int c = column - ring; c <= column + ring; c += edge ? 1 : std::max(1, 2 * ring))
                    for (const PointId other : cells_.cell(c, r)) consider(id, other, neighbors);
            }
        return neighbors;
    }

  private:
    /// Whether a point may be a neighbor: one of another stroke, or of the own one if it returns from far along it.
    bool apart(PointId own, PointId other, float distance) const {
        if (own.stroke != other.stroke) return true;
        const auto count = static_cast<std::int32_t>(strokes_[own.stroke].points.size());
        std::int32_t steps = std::abs(own.point - other.point);
        if (strokes_[own.stroke].closed) steps = std::min(steps, count - steps);
        return static_cast<float>(steps) > k_min_loop_ratio * distance;
    }

    /// Returns the distance across a direction, to the right, to the line through the points around another. That
    /// point alone is the nearest partly by chance, so its distance is biased.
    float across_to(const TracedPoint& point, PointId other, float direction) const {
        const std::vector<TracedPoint>& line = strokes_[other.stroke].points;
        const auto last = static_cast<std::int32_t>(line.size()) - 1;
        const std::int32_t side = std::min({k_line_side, other.point, last - other.point});
        Vec2 mean = Vec2::Zero();
        for (std::int32_t i = other.point - side; i <= other.point + side; ++i) mean += line[i].center;
        const Vec2 way = mean / static_cast<float>(2 * side + 1) - point.center;
        return way.y() * std::cos(direction) - way.x() * std::sin(direction);
    }

    void consider(PointId own, PointId other, Neighbors& neighbors) const {
        const TracedPoint& point = strokes_[own.stroke].points[own.point];
        const TracedPoint& candidate = strokes_[other.stroke].points[other.point];
        const Vec2 way = candidate.center - point.center;
        const float distance = way.norm();
        if (distance >= std::max(neighbors.side[0].distance, neighbors.side[1].distance)) return;
        const float turn = std::remainder(candidate.orientation - point.orientation, std::numbers::pi_v<float>);
        if (std::abs(turn) > similar_ || !apart(own, other, distance)) return;
        const float across = across_to(point, other, point.orientation + 0.5f * turn);
        Neighbor& neighbor = neighbors.side[across > 0 ? 1 : 0];
        if (distance >= neighbor.distance || 2 * across * across < distance * distance) return;
        if (own.stroke != other.stroke && crossing_.cross(own.stroke, other.stroke)) return;
        neighbor = {other, distance, std::abs(across)};
    }

    std::span<const TracedStroke> strokes_;
    CrossingPairs crossing_;
    PointCells cells_;
    float similar_, largest_;
};

/// Removes neighbors that have much nearer neighbors themselves: the stroke is not one of their family.
Neighbors mutual(Neighbors of, const std::vector<std::vector<Neighbors>>& all) {
    for (Neighbor& n : of.side)
        if (n.across > k_farthest_mutual * (n.across > 0 ? all[n.id.stroke][n.id.point].spacing() : 0)) n.across = 0;
    return of;
}

/// Interpolates the spacing within one spacing of measured points: neighbors are interrupted at crossings, for
/// instance.
void bridge_short_gaps(TracedStroke& stroke) {
    std::vector<bool> measured;
    for (const TracedPoint& point : stroke.points) measured.push_back(point.spacing > 0);
    for_each_unmeasured(measured, [&](std::size_t i, const MeasuredNeighbors& b) {
        const float before = stroke.points[b.before].spacing, behind = stroke.points[b.behind].spacing;
        const auto gap = [&](std::size_t end) { return static_cast<float>(i > end ? i - end : end - i); };
        if (gap(b.before) <= before || gap(b.behind) <= behind)
            stroke.points[i].spacing = std::lerp(before, behind, b.share);
    });
}

}  // namespace

void measure_spacings(std::span<const StrokeCrossing> crossings, float similar, float largest,
                      std::span<TracedStroke> strokes) {
    const SpacingSearch search(crossings, similar, largest, strokes);
    std::vector<std::vector<Neighbors>> neighbors(strokes.size());
    parallel_for(
        strokes.size(),
        [&](std::size_t s) {
            for (std::size_t p = 0; p < strokes[s].points.size(); ++p)
                neighbors[s].push_back(
                    search.neighbors_of({static_cast<std::int32_t>(s), static_cast<std::int32_t>(p)}));
        },
        8);
    for (std::size_t s = 0; s < strokes.size(); ++s) {
        for (std::size_t p = 0; p < neighbors[s].size(); ++p)
            strokes[s].points[p].spacing = mutual(neighbors[s][p], neighbors).spacing();
        bridge_short_gaps(strokes[s]);
    }
}

}  // namespace exemplar
