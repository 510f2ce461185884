#include "host/hatching/stroke_tracing.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <vector>

#include "host/hatching/occlusion_barriers.h"

namespace exemplar {
namespace {

/// Directions between pixels count where their mean is at least so long, in shares of one of theirs.
constexpr std::int32_t k_least_agreement = 358;
/// A stroke beside is at one spacing, and a little for rounding; where its own gap is, it is farther.
constexpr std::int32_t k_beside = 1050;
/// A stroke that has turned by so much, as a sum of sines times k_unit, may come back to itself.
constexpr std::int32_t k_far_turn = 2 * k_unit;

std::int32_t signed_half(std::uint32_t word) {
    return static_cast<std::int16_t>(static_cast<std::uint16_t>(word));
}

/// The four pixels around a point, [row][column], and which of them its own pixel reaches.
struct Corners {
    std::array<std::array<PlacementTexel, 2>, 2> texels;
    int home_x, home_y;

    bool free_along(int row) const { return !(texels[row][0].flags & k_barrier_right); }
    bool free_down(int column) const { return !(texels[0][column].flags & k_barrier_below); }
    bool reaches(int x, int y) const {
        const bool along = x != home_x, down = y != home_y;
        if (along && down) return (free_along(home_y) && free_down(x)) || (free_down(home_x) && free_along(y));
        return along ? free_along(home_y) : !down || free_down(home_x);
    }
};

/// Half of the angle of (c, s), whose length is given, that is nearer to `heading`.
Direction half_angle(std::int32_t c, std::int32_t s, std::int32_t length, Direction heading) {
    // Of the two formulas the one that does not cancel.
    const Direction half = c >= 0 ? direction_of(length + c, s) : direction_of(s, length - c);
    return dot(half, heading) < 0 ? -half : half;
}

FinePoint moved(FinePoint from, Direction way, std::int32_t distance) {
    constexpr std::int32_t k_half = k_unit / 2;
    return {from.x + ((way.x * distance + k_half) >> k_unit_bits),
            from.y + ((way.y * distance + k_half) >> k_unit_bits)};
}

enum class StrokeEnd { none, length, region, crowd };

/// One side of a stroke, from the seed on.
struct Branch {
    FinePoint tip;
    Direction heading;
    std::vector<FinePoint> points;  ///< without the seed
    std::int32_t turn = 0;          ///< the sum of the sines of its turns
    std::int32_t steps = 0;         ///< that it would have by its length
    StrokeEnd end = StrokeEnd::none;

    std::int32_t reach() const { return static_cast<std::int32_t>(points.size()); }
};

/// A part of a way, in steps from its beginning.
struct Span {
    std::int32_t begin, end;
    std::int32_t steps() const { return end - begin; }
};

class Tracer {
  public:
    Tracer(const PlacementGrid& grid, const Clearance& clearance, const StrokeSeed& seed)
        : grid_(grid), clearance_(clearance), seed_(seed) {
        const auto x = static_cast<std::uint32_t>(seed.point.x), y = static_cast<std::uint32_t>(seed.point.y);
        const std::uint32_t chance = scatter(x ^ scatter(y ^ scatter(grid.rules.seed + seed.layer)));
        length_share_ = (1 << k_share_bits) +
                        ((static_cast<std::int32_t>(chance & 2047U) - 1024) * grid.rules.jitter >> k_share_bits);
        first_share_ = 256 + static_cast<std::int32_t>(chance >> 11 & 511U);
        branches_[0].heading = seed.heading;
        branches_[1].heading = -seed.heading;
        branches_[0].tip = branches_[1].tip = seed.point;
    }

    bool trace(StrokeCandidate& candidate) {
        walk(branches_[0], first_share_);
        walk(branches_[1], 1 << k_share_bits);
        if (branches_[0].end == StrokeEnd::length) walk(branches_[0], 1 << k_share_bits);
        for (Branch& branch : branches_) look_ahead(branch);
        const Span span = fitted();
        if (span.steps() < least_steps(grid_, *grid_.at(seed_.point), crowded_ends())) return false;
        give(span, candidate);
        return true;
    }

  private:
    /// The target length at a point, of a stroke of a share of it.
    std::int32_t target_steps(FinePoint at, std::int32_t share) const {
        return grid_.at(at)->length() * share >> (k_share_bits + k_length_bits);
    }
    std::int32_t crowded_ends() const {
        return (branches_[0].end == StrokeEnd::crowd ? 1 : 0) + (branches_[1].end == StrokeEnd::crowd ? 1 : 0);
    }

    /// Walks on at one end until the stroke has a share of its target length, or cannot.
    void walk(Branch& branch, std::int32_t share) {
        branch.end = StrokeEnd::none;
        while (branch.end == StrokeEnd::none) {
            if (branches_[0].reach() + branches_[1].reach() >= target_steps(branch.tip, length_share_) * share >>
                k_share_bits)
                branch.end = StrokeEnd::length;
            else
                step(branch);
        }
        branch.steps = branch.reach();
    }

    /// Where a stroke ends by its length, walks on as far as a gap and the least of further strokes would take.
    void look_ahead(Branch& branch) {
        if (branch.end != StrokeEnd::length) return;
        const PlacementTexel& texel = *grid_.at(seed_.point);
        const std::int32_t most = branch.steps + gap_steps(texel) + least_steps(grid_, texel, 2);
        branch.end = StrokeEnd::none;
        while (branch.end == StrokeEnd::none) {
            if (branch.reach() == most)
                branch.end = StrokeEnd::length;
            else
                step(branch);
        }
    }
    std::int32_t gap_steps(const PlacementTexel& texel) const {
        return (share_of_spacing(texel.spacing(), grid_.rules.test_share) >> k_pixel_bits) + 1;
    }

    /// The part of the way that becomes the stroke: where there is too little room for another between its end and what
    /// ends the way, it is moved up to that, or takes all of the way, or leaves half of it to another.
    Span fitted() const {
        const Branch &on = branches_[0], &back = branches_[1];
        const std::int32_t steps = on.steps + back.steps, all = on.reach() + back.reach();
        const bool on_is_free = on.end == StrokeEnd::length, back_is_free = back.end == StrokeEnd::length;
        if (on_is_free && back_is_free)
            return out_of_line({back.reach() - back.steps, back.reach() + on.steps}, {1, 1});
        if (on_is_free) return out_of_line({0, steps}, {0, -1});
        if (back_is_free) return out_of_line({all - steps, all}, {1, 0});
        const PlacementTexel& texel = *grid_.at(seed_.point);
        if (all <= target_steps(seed_.point, (1 << k_share_bits) + grid_.rules.jitter)) return {0, all};
        const std::int32_t half = std::max((all - gap_steps(texel)) / 2, least_steps(grid_, texel, 2));
        return on.steps == on.reach() ? Span{all - half, all} : Span{0, half};
    }

    /// A part, or it moved by up to two gaps either way, or shortened by as much at its free end (both given as how its
    /// ends move): the first of which the fewest free ends have their gap beside that of another stroke.
    Span out_of_line(const Span& span, const Span& move) const {
        const std::int32_t gap = gap_steps(*grid_.at(seed_.point)), all = branches_[0].reach() + branches_[1].reach();
        Span best = span;
        std::int32_t least = 3;
        for (const std::int32_t shift : {0, gap, -gap, 2 * gap, -2 * gap}) {
            const Span moved{span.begin + shift * move.begin, span.end + shift * move.end};
            if (moved.begin < 0 || moved.end > all || moved.steps() > span.steps() ||
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
    /// 1 if no stroke passes beside this place of the way, or it is not known.
    std::int32_t is_in_line(std::int32_t place) const {
        if (place < 0 || place > branches_[0].reach() + branches_[1].reach()) return 1;
        const FinePoint point = point_at(place);
        return clearance_.is_clear(seed_.layer, point, grid_.at(point)->spacing(), k_beside) ? 1 : 0;
    }
    FinePoint point_at(std::int32_t place) const {
        const std::int32_t from_seed = place - branches_[1].reach();
        return from_seed == 0  ? seed_.point
               : from_seed > 0 ? branches_[0].points[static_cast<std::size_t>(from_seed - 1)]
                               : branches_[1].points[static_cast<std::size_t>(-from_seed - 1)];
    }

    void give(const Span& span, StrokeCandidate& candidate) const {
        candidate.stroke.layer = seed_.layer;
        candidate.way.clear();
        for (std::int32_t i = 0; i <= branches_[0].reach() + branches_[1].reach(); ++i)
            candidate.way.push_back(point_at(i));
        candidate.stroke.points.assign(candidate.way.begin() + span.begin, candidate.way.begin() + span.end + 1);
        const std::int32_t quarters = 4 * span.steps() / std::max(target_steps(seed_.point, length_share_), 1);
        candidate.shortness = static_cast<std::uint32_t>(3 - std::clamp(quarters, 0, 3));
    }

    void step(Branch& branch) {
        const FinePoint middle = moved(branch.tip, branch.heading, k_step / 2);
        const Direction way = direction_at(grid_, seed_.layer, middle, branch.heading);
        const FinePoint next = moved(branch.tip, way, k_step);
        const PlacementTexel* texel = grid_.at(next);
        if (!way || !texel || !texel->hatched(seed_.layer) || !is_free_step(grid_, branch.tip, next) ||
            dot(way, branch.heading) < grid_.rules.least_turn_cosine * k_unit) {
            branch.end = StrokeEnd::region;
            return;
        }
        branch.turn += cross(branch.heading, way) >> k_unit_bits;
        if (!clearance_.is_clear(seed_.layer, next, texel->spacing(), grid_.rules.test_share) ||
            (std::abs(branches_[0].turn - branches_[1].turn) > k_far_turn && meets_itself(branch, next, *texel))) {
            branch.end = StrokeEnd::crowd;
            return;
        }
        branch.tip = next;
        branch.heading = way;
        branch.points.push_back(next);
    }

    /// Whether a point comes nearer than the test distance to what the stroke has passed, beyond what it just did.
    bool meets_itself(const Branch& branch, FinePoint next, const PlacementTexel& texel) const {
        const int shift = grid_.rules.near_shift;
        const std::int32_t least = share_of_spacing(texel.spacing(), grid_.rules.test_share);
        const auto near = [&](FinePoint other) {
            const std::int32_t x = (other.x - next.x) >> shift, y = (other.y - next.y) >> shift;
            // What is far along an axis is far, and its square may be too large.
            if (std::max(std::abs(x), std::abs(y)) > least >> shift) return false;
            return x * x + y * y < (least >> shift) * (least >> shift);
        };
        const Branch& other = branches_[&branch == branches_.data() ? 1 : 0];
        const auto recent = static_cast<std::size_t>(2 * least >> k_pixel_bits);
        for (std::size_t i = 0; i + recent < branch.points.size(); ++i)
            if (near(branch.points[i])) return true;
        for (std::size_t i = 0; i < other.points.size(); ++i)
            if (i + branch.points.size() > recent && near(other.points[i])) return true;
        return false;
    }

    const PlacementGrid& grid_;
    const Clearance& clearance_;
    const StrokeSeed& seed_;
    std::int32_t length_share_ = 0, first_share_ = 0;
    std::array<Branch, 2> branches_;
};

}  // namespace

Direction direction_at(const PlacementGrid& grid, std::uint32_t layer, FinePoint point, Direction heading) {
    const PlacementTexel* home = grid.at(point);
    if (!home || !home->hatched(layer)) return {};
    const std::int32_t x = point.x - k_pixel / 2, y = point.y - k_pixel / 2;
    const int left = x >> k_pixel_bits, top = y >> k_pixel_bits;
    Corners corners{{}, (point.x >> k_pixel_bits) - left, (point.y >> k_pixel_bits) - top};
    for (int j = 0; j < 2; ++j)
        for (int i = 0; i < 2; ++i)
            if (grid.inside(left + i, top + j)) corners.texels[j][i] = grid.at(left + i, top + j);

    const std::int32_t right_part = (x & (k_pixel - 1)) >> 4, lower_part = (y & (k_pixel - 1)) >> 4;
    std::int32_t c = 0, s = 0, total = 0;
    for (int j = 0; j < 2; ++j)
        for (int i = 0; i < 2; ++i) {
            const std::uint32_t word = corners.texels[j][i].directions[layer];
            if (word == 0 || !corners.reaches(i, j)) continue;
            const std::int32_t weight = (i ? right_part : 256 - right_part) * (j ? lower_part : 256 - lower_part);
            c += weight * signed_half(word);
            s += weight * signed_half(word >> 16);
            total += weight;
        }
    c = (c + (1 << 15)) >> 16;
    s = (s + (1 << 15)) >> 16;
    const auto length = static_cast<std::int32_t>(floor_sqrt(static_cast<std::uint32_t>(c * c + s * s)));
    // The weights of all four pixels are 2^16 together, directions 2^14 long and shares 2^10.
    if (length == 0 || length << 12 < total * k_least_agreement) return {};
    return half_angle(c, s, length, heading);
}

std::int32_t least_steps(const PlacementGrid& grid, const PlacementTexel& texel, std::int32_t crowded_ends) {
    const std::int32_t by_length = texel.length() * grid.rules.least_share >> (k_share_bits + k_length_bits);
    const std::int32_t by_spacing = (1 + crowded_ends) * texel.spacing() >> k_spacing_bits;
    return std::max(std::min(by_length, by_spacing), k_least_steps);
}

bool trace_stroke(const PlacementGrid& grid, const Clearance& clearance, const StrokeSeed& seed,
                  StrokeCandidate& candidate) {
    return Tracer(grid, clearance, seed).trace(candidate);
}

}  // namespace exemplar
