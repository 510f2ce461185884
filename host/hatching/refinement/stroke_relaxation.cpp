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

// Damps the oscillation of neighbors, as all strokes move at once.
constexpr float k_damping = 0.5f;
// In spacings. A wider gap is a hole, or the ray runs through the gap between two strokes in line; moving strokes
// closes neither.
constexpr float k_hole = 1.7f;

/// A stroke's displacement across: an offset and a rotation about its middle, in pixels and radians.
struct Move {
    float offset = 0, turn = 0;
};

/// Returns the displacement of a point along `across` that balances its gaps, in spacings; 0 without neighbors.
float balancing_offset(const StrokeGaps::Gaps& gaps) {
    const float ahead = gaps.ratio[0], behind = gaps.ratio[1];
    const bool to = ahead < k_hole, from = behind < k_hole;
    if (to && from) return (ahead - behind) / 2;
    // A neighbor on one side meets it half way.
    return to ? (ahead - 1) / 2 : from ? (1 - behind) / 2 : 0;
}

/// Fits a move to the displacements of a stroke's points by least squares.
Move fit_gaps(const std::vector<StrokeGaps::Gaps>& gaps) {
    // Points are spaced about evenly.
    const auto count = static_cast<float>(gaps.size());
    const float middle = (count - 1) / 2;
    float sum = 0, moment = 0, squares = 0;
    for (std::size_t i = 0; i < gaps.size(); ++i) {
        const float t = static_cast<float>(i) - middle, pixels = balancing_offset(gaps[i]) * gaps[i].spacing;
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
    /// Returns the moved points of a stroke.
    std::vector<Vec2> moved(std::uint32_t index, const StrokeGaps& gaps) {
        const HatchStroke& stroke = strokes_[index];
        std::vector<Vec2> points = stroke.points;
        const std::vector<StrokeGaps::Gaps> beside = gaps.beside(index);
        if (points.size() < 2) return points;
        const Move step = fit_gaps(beside);
        const float spacing = beside[points.size() / 2].spacing, length = (points[1] - points[0]).norm();
        Move& all = moved_[index];
        const Move before = all;
        const float most = k_max_relaxation_offset * spacing;
        all.offset = std::clamp(all.offset + step.offset, -most, most);
        const float turn = k_max_relaxation_rotation * length;  // displacement from a point to the next
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
    std::vector<Move> moved_;  // total move of each stroke
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
