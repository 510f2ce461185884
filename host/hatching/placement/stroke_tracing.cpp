#include "host/hatching/placement/stroke_tracing.h"

#include <algorithm>

namespace exemplar {
namespace {

/// Beside a stroke, the nearest stroke is closer than the first share of the spacing; beside the gap at its end,
/// closer than the second.
constexpr std::int32_t k_beside_stroke = 1032, k_beside_gap = 1250;

/// A part of a streamline, in steps from its beginning.
struct Span {
    std::int32_t begin, end;
    std::int32_t steps() const { return end - begin; }
};

/// Finds the part of a streamline that becomes the stroke.
class Fitter {
  public:
    Fitter(const PlacementGrid& grid, const Clearance& clearance, const Streamline& way, std::uint32_t layer)
        : grid_(grid), clearance_(clearance), way_(way), layer_(layer) {}

    /// Returns the part that becomes the stroke. With too little room for another stroke at an end, it is moved up
    /// to the obstacle there; with too little at both, it takes the whole streamline, or leaves half of it to
    /// another stroke.
    Span fitted() const {
        const StrokeBranch &on = way_.on(), &back = way_.back();
        const std::int32_t steps = on.steps + back.steps, all = way_.last();
        const bool on_is_free = on.end == StrokeEnd::length, back_is_free = back.end == StrokeEnd::length;
        if (on_is_free && back_is_free)
            return out_of_line({back.reach() - back.steps, back.reach() + on.steps}, {1, 1});
        if (on_is_free) return out_of_line({0, steps}, {0, -1});
        if (back_is_free) return out_of_line({all - steps, all}, {1, 0});
        const std::int32_t most = Streamline::target_steps(way_.texel(), (1 << k_share_bits) + grid_.rules.jitter);
        if (all <= most) return {0, all};
        const std::int32_t half =
            std::min(all, std::max((all - way_.gap_steps()) / 2, min_stroke_steps(grid_, way_.texel(), 2)));
        return on.steps == on.reach() ? Span{all - half, all} : Span{0, half};
    }

  private:
    /// Avoids gaps side by side. Tries the part as it is and with its ends moved by one and two gaps either way,
    /// where `move` tells how each end moves (both: shifted; one: shortened). Returns the first one whose free ends
    /// have the fewest gaps beside the gap of another stroke.
    Span out_of_line(const Span& span, const Span& move) const {
        const std::int32_t gap = way_.gap_steps();
        Span best = span;
        std::int32_t least = 3;
        for (const std::int32_t shift : {0, gap, -gap, 2 * gap, -2 * gap}) {
            const Span moved{span.begin + shift * move.begin, span.end + shift * move.end};
            if (moved.begin < 0 || moved.end > way_.last() || moved.steps() > span.steps() ||
                4 * moved.steps() < 3 * span.steps())
                continue;
            const std::int32_t in_line = (move.begin == 0 ? 0 : is_in_line(moved.begin - gap / 2)) +
                                         (move.end == 0 ? 0 : is_in_line(moved.end + gap / 2));
            if (in_line >= least) continue;
            least = in_line;
            best = moved;
        }
        return best;
    }
    /// Returns 1 if a place of the streamline is beside the gap at the end of another stroke: the nearest stroke is
    /// over one spacing away, but not as far as beyond that gap. Also 1 if the place is outside of the streamline.
    std::int32_t is_in_line(std::int32_t place) const {
        if (place < 0 || place > way_.last()) return 1;
        const FinePoint point = way_.point_at(place);
        const std::int32_t spacing = grid_.at(point)->spacing();
        const bool is_beside_gap = clearance_.is_clear(layer_, point, spacing, k_beside_stroke) &&
                                   !clearance_.is_clear(layer_, point, spacing, k_beside_gap);
        return is_beside_gap ? 1 : 0;
    }

    const PlacementGrid& grid_;
    const Clearance& clearance_;
    const Streamline& way_;
    std::uint32_t layer_;
};

std::int32_t crowded_ends(const Streamline& way) {
    return (way.on().end == StrokeEnd::crowd ? 1 : 0) + (way.back().end == StrokeEnd::crowd ? 1 : 0);
}

std::uint32_t shortness_of(const Streamline& way, std::int32_t steps) {
    const std::int32_t target = std::max(Streamline::target_steps(way.texel(), way.length_share()), 1);
    return static_cast<std::uint32_t>(3 - std::clamp(4 * steps / target, 0, 3));
}

}  // namespace

bool trace_stroke(const PlacementGrid& grid, const Clearance& clearance, const StrokeSeed& seed,
                  StrokeCandidate& candidate) {
    const Streamline way(grid, clearance, seed);
    const Span span = Fitter(grid, clearance, way, seed.layer).fitted();
    if (span.steps() < min_stroke_steps(grid, way.texel(), crowded_ends(way))) return false;
    candidate.way.clear();
    for (std::int32_t i = 0; i <= way.last(); ++i) candidate.way.push_back(way.point_at(i));
    candidate.stroke.layer = seed.layer;
    candidate.stroke.points.assign(candidate.way.begin() + span.begin, candidate.way.begin() + span.end + 1);
    candidate.shortness = shortness_of(way, span.steps());
    return true;
}

}  // namespace exemplar
