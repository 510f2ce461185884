#include "host/hatching/refinement/stroke_relaxation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "host/core/errors.h"
#include "host/core/parallel.h"
#include "host/hatching/placement/stroke_gaps.h"

namespace exemplar {
namespace {

// All strokes move at once: by the whole way they would swing.
constexpr float k_damping = 0.5f;
// What is wider is a hole, or the view along a gap between strokes in line: nothing that moving strokes would mend.
constexpr float k_hole = 1.7f;

/// A stroke's displacement across: an offset and a turn about its middle, in pixels and radians.
struct Move {
    float offset = 0, turn = 0;
};

/// How far a point would move towards `across`, in spacings; 0 if there is nothing beside it.
float wish(const StrokeGaps::Gaps& gaps) {
    const float ahead = gaps.ratio[0], behind = gaps.ratio[1];
    const bool to = ahead < k_hole, from = behind < k_hole;
    if (to && from) return (ahead - behind) / 2;
    // A neighbor on one side meets it half way.
    return to ? (ahead - 1) / 2 : from ? (1 - behind) / 2 : 0;
}

/// The move that fits the wishes of a stroke's points best, by least squares.
Move fit(const std::vector<StrokeGaps::Gaps>& gaps) {
    // Points are about evenly apart.
    const auto count = static_cast<float>(gaps.size());
    const float middle = (count - 1) / 2;
    float sum = 0, moment = 0, squares = 0;
    for (std::size_t i = 0; i < gaps.size(); ++i) {
        const float t = static_cast<float>(i) - middle, pixels = wish(gaps[i]) * gaps[i].spacing;
        sum += pixels;
        moment += t * pixels;
        squares += t * t;
    }
    return {k_damping * sum / count, squares > 0 ? k_damping * moment / squares : 0};
}

class Relaxation {
  public:
    Relaxation(std::span<HatchStroke> strokes, const HatchingFields& fields)
        : strokes_(strokes), fields_(fields), moved_(strokes.size()) {}

    void iterate() {
        const StrokeGaps gaps(strokes_, fields_);
        std::vector<std::vector<Vec2>> points(strokes_.size());
        parallel_for(
            strokes_.size(), [&](std::size_t i) { points[i] = moved(static_cast<std::uint32_t>(i), gaps); }, 16);
        for (std::size_t i = 0; i < points.size(); ++i) strokes_[i].points = std::move(points[i]);
    }

  private:
    /// Where the points of a stroke go.
    std::vector<Vec2> moved(std::uint32_t index, const StrokeGaps& gaps) {
        const HatchStroke& stroke = strokes_[index];
        std::vector<Vec2> points = stroke.points;
        const std::vector<StrokeGaps::Gaps> beside = gaps.beside(index);
        if (points.size() < 2) return points;
        const Move step = fit(beside);
        const float spacing = beside[points.size() / 2].spacing, length = (points[1] - points[0]).norm();
        Move& all = moved_[index];
        const Move before = all;
        const float most = k_most_relaxing * spacing;
        all.offset = std::clamp(all.offset + step.offset, -most, most);
        const float turn = k_most_relaxing_turn * length;  // across, from a point to the next
        all.turn = std::clamp(all.turn + step.turn, -turn, turn);
        const float middle = static_cast<float>(points.size() - 1) / 2;
        for (std::size_t i = 0; i < points.size(); ++i) {
            const float t = static_cast<float>(i) - middle;
            points[i] += (all.offset - before.offset + t * (all.turn - before.turn)) * beside[i].across;
            if (gaps.is_hatched(stroke.points[i], stroke.layer) && gaps.is_hatched(points[i], stroke.layer)) continue;
            all = before;
            return stroke.points;
        }
        return points;
    }

    std::span<HatchStroke> strokes_;
    const HatchingFields& fields_;
    std::vector<Move> moved_;  // of each stroke, since the beginning
};

}  // namespace

void relax_spacing(std::span<HatchStroke> strokes, const HatchingFields& fields, int iterations) {
    if (iterations < 0) throw UsageError(fmt::format("spacing cannot be relaxed in {} iterations", iterations));
    Relaxation relaxation(strokes, fields);
    for (int i = 0; i < iterations; ++i) relaxation.iterate();
}

std::vector<HatchStroke> place_evenly(StrokePlacer& placer, const HatchingFields& fields,
                                      std::span<const std::uint8_t> barriers, const StrokeOptions& options,
                                      std::span<const HatchStroke> kept) {
    std::vector<HatchStroke> strokes = placer.place(fields, barriers, options, kept);
    for (int round = 0; round < 2; ++round) {
        relax_spacing(strokes, fields);
        strokes = placer.place(fields, barriers, options, strokes);
    }
    return strokes;
}

}  // namespace exemplar
