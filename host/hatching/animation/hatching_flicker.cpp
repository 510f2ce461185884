#include "host/hatching/animation/hatching_flicker.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <unordered_map>
#include <vector>

#include "host/hatching/fields/hatching_fields.h"

namespace exemplar {
namespace {

float distance_to_segment(const Vec2& point, const Vec2& a, const Vec2& b) {
    const Vec2 way = b - a;
    const float square = way.squaredNorm();
    const float t = square > 0 ? std::clamp((point - a).dot(way) / square, 0.0f, 1.0f) : 0.0f;
    return (a + t * way - point).norm();
}

/// The segments of a layer's strokes, in all cells of the picture that they come near.
class SegmentCells {
  public:
    void add(const HatchStroke& stroke) {
        for (std::size_t i = 0; i + 1 < stroke.points.size(); ++i) {
            const std::array<Vec2, 2> ends{stroke.points[i], stroke.points[i + 1]};
            const Vec2 margin(k_same_stroke, k_same_stroke);
            const Vec2 low = ends[0].cwiseMin(ends[1]) - margin, high = ends[0].cwiseMax(ends[1]) + margin;
            for (int y = cell(low.y()); y <= cell(high.y()); ++y)
                for (int x = cell(low.x()); x <= cell(high.x()); ++x) cells_[key(x, y)].push_back(ends);
        }
    }
    bool has_at(const Vec2& point) const {
        const auto found = cells_.find(key(cell(point.x()), cell(point.y())));
        return found != cells_.end() && std::ranges::any_of(found->second, [&](const std::array<Vec2, 2>& ends) {
                   return distance_to_segment(point, ends[0], ends[1]) <= k_same_stroke;
               });
    }

  private:
    static constexpr float k_cell = 4;  // pixels
    static int cell(float x) { return static_cast<int>(std::floor(x / k_cell)); }
    static std::uint64_t key(int x, int y) {
        return std::uint64_t{static_cast<std::uint32_t>(x)} << 32 | static_cast<std::uint32_t>(y);
    }
    std::unordered_map<std::uint64_t, std::vector<std::array<Vec2, 2>>> cells_;
};

/// Ends of strokes, sorted by x.
class StrokeEnds {
  public:
    void add(const HatchStroke& stroke) {
        if (stroke.points.empty()) return;
        ends_.push_back(stroke.points.front());
        ends_.push_back(stroke.points.back());
    }
    void sort() {
        std::ranges::sort(ends_, {}, [](const Vec2& end) { return end.x(); });
    }
    bool empty() const { return ends_.empty(); }
    float nearest(const Vec2& point) const {
        float best = std::numeric_limits<float>::max();
        const auto middle = std::ranges::lower_bound(ends_, point.x(), {}, [](const Vec2& end) { return end.x(); });
        for (auto end = middle; end != ends_.end() && end->x() - point.x() < best; ++end)
            best = std::min(best, (*end - point).norm());
        for (auto end = middle; end != ends_.begin() && point.x() - std::prev(end)->x() < best; --end)
            best = std::min(best, (*std::prev(end) - point).norm());
        return best;
    }

  private:
    std::vector<Vec2> ends_;
};

/// Total length of strokes, and the length of what has no counterpart in the other frame.
struct Length {
    double all = 0, elsewhere = 0;
    void add(const HatchStroke& stroke, const SegmentCells& others) {
        for (std::size_t i = 0; i + 1 < stroke.points.size(); ++i) {
            const double length = static_cast<double>((stroke.points[i + 1] - stroke.points[i]).norm());
            all += length;
            if (!others.has_at(0.5f * (stroke.points[i] + stroke.points[i + 1]))) elsewhere += length;
        }
    }
    float share() const { return all > 0 ? static_cast<float>(elsewhere / all) : 0.0f; }
};

}  // namespace

HatchingFlicker measure_flicker(std::span<const HatchStroke> strokes, std::span<const AdvectedStroke> before) {
    std::array<SegmentCells, k_hatch_layers> now_at, then_at;
    std::array<StrokeEnds, k_hatch_layers> ends;
    for (const HatchStroke& stroke : strokes) {
        now_at[stroke.layer].add(stroke);
        ends[stroke.layer].add(stroke);
    }
    for (const AdvectedStroke& carried : before) then_at[carried.stroke.layer].add(carried.stroke);
    for (StrokeEnds& some : ends) some.sort();
    Length now, then;
    double slip = 0, count = 0;
    for (const HatchStroke& stroke : strokes) now.add(stroke, then_at[stroke.layer]);
    for (const auto& [stroke, is_whole] : before) {
        then.add(stroke, now_at[stroke.layer]);
        for (std::size_t side = 0; side < 2; ++side) {
            if (!is_whole[side] || ends[stroke.layer].empty()) continue;
            slip += static_cast<double>(
                ends[stroke.layer].nearest(side == 0 ? stroke.points.front() : stroke.points.back()));
            ++count;
        }
    }
    return {static_cast<float>(now.all), now.share(), then.share(), count > 0 ? static_cast<float>(slip / count) : 0};
}

HatchingFlicker mean_flicker(std::span<const HatchingFlicker> pictures) {
    HatchingFlicker mean;
    float drawn = 0;
    for (const HatchingFlicker& one : pictures) {
        drawn += one.drawn;
        mean.appeared += one.drawn * one.appeared;
        mean.vanished += one.drawn * one.vanished;
        mean.slip += one.drawn * one.slip;
    }
    if (!(drawn > 0)) return mean;
    return {drawn / static_cast<float>(pictures.size()), mean.appeared / drawn, mean.vanished / drawn,
            mean.slip / drawn};
}

}  // namespace exemplar
