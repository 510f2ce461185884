#include "host/hatching/placement/streamline_steps.h"

#include <algorithm>
#include <cstdlib>

#include "host/hatching/placement/stroke_directions.h"

namespace exemplar {
namespace {

/// A stroke may meet itself once it has turned by more than k_far_turn (a sum of sines, times k_unit). Distances to
/// itself are in units of 2^k_itself_bits (1/16 pixel) and measured to at most k_max_pieces pieces of it.
constexpr std::int32_t k_far_turn = 2 * k_unit;
constexpr int k_itself_bits = 8;
constexpr std::int32_t k_max_pieces = 32;
constexpr std::int32_t k_far_from_itself = 1 << 20;

FinePoint moved(FinePoint from, Direction way, std::int32_t distance) {
    constexpr std::int32_t k_half = k_unit / 2;
    return {from.x + ((way.x * distance + k_half) >> k_unit_bits),
            from.y + ((way.y * distance + k_half) >> k_unit_bits)};
}

/// Returns the distance of a point to the segment between two others, in units of 2^k_itself_bits.
std::int32_t distance_to_line(FinePoint point, FinePoint from, FinePoint to) {
    const auto coarse = [](FinePoint way) { return Direction{way.x >> k_itself_bits, way.y >> k_itself_bits}; };
    const auto length = [](Direction way) {
        return static_cast<std::int32_t>(floor_sqrt(static_cast<std::uint32_t>(dot(way, way))));
    };
    const Direction line = coarse(to - from), begin = coarse(point - from);
    const std::int32_t along = dot(begin, line);
    if (along <= 0) return length(begin);
    if (along >= dot(line, line)) return length(coarse(point - to));
    return std::abs(cross(begin, line)) / length(line);
}

}  // namespace

std::optional<StrokeStep> next_step(const PlacementGrid& grid, std::uint32_t layer, FinePoint tip, Direction heading) {
    const FinePoint middle = moved(tip, heading, k_step / 2);
    const Direction way = direction_at(grid, layer, middle, heading);
    const FinePoint next = moved(tip, way, k_step);
    const PlacementTexel* texel = grid.at(next);
    if (!way || !texel || !texel->hatched(layer) || !is_free_step(grid, tip, next) ||
        dot(way, heading) < grid.rules.min_turn_cosine * k_unit)
        return std::nullopt;
    return StrokeStep{next, way};
}

Streamline::Streamline(const PlacementGrid& grid, const Clearance& clearance, const StrokeSeed& seed)
    : grid_(grid), clearance_(clearance), seed_(seed), texel_(*grid.at(seed.point)) {
    const auto x = static_cast<std::uint32_t>(seed.point.x), y = static_cast<std::uint32_t>(seed.point.y);
    const std::uint32_t chance = scatter(x ^ scatter(y ^ scatter(grid.rules.seed + seed.layer)));
    length_share_ =
        (1 << k_share_bits) + ((static_cast<std::int32_t>(chance & 2047U) - 1024) * grid.rules.jitter >> k_share_bits);
    const std::int32_t first_share = 256 + static_cast<std::int32_t>(chance >> 11 & 511U);
    auto& [on, back] = branches_;
    on.heading = seed.heading;
    back.heading = -seed.heading;
    on.tip = back.tip = seed.point;
    walk(on, first_share);
    walk(back, 1 << k_share_bits);
    if (on.end == StrokeEnd::length) walk(on, 1 << k_share_bits);
    look_ahead(on);
    look_ahead(back);
}

std::int32_t Streamline::gap_steps() const {
    return (share_of_spacing(texel_.spacing(), grid_.rules.test_share) >> k_pixel_bits) + 1;
}

FinePoint Streamline::from_seed(std::int32_t i) const {
    if (i == 0) return seed_.point;
    return branches_[i > 0 ? 0 : 1].points[static_cast<std::size_t>(std::abs(i) - 1)];
}

/// Traces one end until the stroke has a share of its target length or is stopped.
void Streamline::walk(StrokeBranch& branch, std::int32_t share) {
    branch.end = StrokeEnd::none;
    branch.unchecked_steps = 0;
    while (branch.end == StrokeEnd::none) {
        if (last() >= target_steps(*grid_.at(branch.tip), length_share_) * share >> k_share_bits)
            branch.end = StrokeEnd::length;
        else
            step(branch);
    }
    branch.steps = branch.reach();
}

void Streamline::look_ahead(StrokeBranch& branch) {
    if (branch.end != StrokeEnd::length) return;
    const std::int32_t most = branch.steps + gap_steps() + min_stroke_steps(grid_, texel_, 2);
    branch.end = StrokeEnd::none;
    branch.unchecked_steps = 0;
    while (branch.end == StrokeEnd::none) {
        if (branch.reach() == most)
            branch.end = StrokeEnd::length;
        else
            step(branch);
    }
}

void Streamline::step(StrokeBranch& branch) {
    const auto next = next_step(grid_, seed_.layer, branch.tip, branch.heading);
    if (!next) {
        branch.end = StrokeEnd::region;
        return;
    }
    branch.turn += cross(branch.heading, next->heading) >> k_unit_bits;
    const PlacementTexel& texel = *grid_.at(next->point);
    if (!clearance_.is_clear(seed_.layer, next->point, texel.spacing(), grid_.rules.test_share) ||
        meets_itself(branch, next->point, texel)) {
        branch.end = StrokeEnd::crowd;
        return;
    }
    min_turn_ = std::min(min_turn_, branch.turn);
    max_turn_ = std::max(max_turn_, branch.turn);
    branch.tip = next->point;
    branch.heading = next->heading;
    branch.points.push_back(next->point);
}

/// Returns whether a point is within the test distance of the stroke itself, except its latest part.
bool Streamline::meets_itself(StrokeBranch& branch, FinePoint next, const PlacementTexel& texel) const {
    if (branch.unchecked_steps > 0) {
        --branch.unchecked_steps;
        return false;
    }
    if (std::max(branch.turn - min_turn_, max_turn_ - branch.turn) <= k_far_turn) return false;
    const std::int32_t test = share_of_spacing(texel.spacing(), grid_.rules.test_share);
    const std::int32_t beyond = distance_to_itself(branch, next, test) - (test >> k_itself_bits);
    branch.unchecked_steps = beyond >> (k_pixel_bits - k_itself_bits);
    return beyond < 0;
}

/// Returns the distance from a point to the stroke, except the last two test distances before it. For far pieces a
/// lower bound is used.
std::int32_t Streamline::distance_to_itself(const StrokeBranch& branch, FinePoint next, std::int32_t test) const {
    const std::int32_t sign = &branch == branches_.data() ? 1 : -1;
    const std::int32_t begin = branch.reach() - last(), end = branch.reach() - (2 * test >> k_pixel_bits);
    const std::int32_t stride = 1 + (end - begin) / k_max_pieces;
    std::int32_t nearest = k_far_from_itself;
    for (std::int32_t i = begin; i < end; i += stride) {
        const FinePoint from = from_seed(sign * i), way = next - from;
        const std::int32_t afar = (std::max(std::abs(way.x), std::abs(way.y)) - stride * k_pixel) >> k_itself_bits;
        const bool is_far = afar > 2 * test >> k_itself_bits;
        nearest = std::min(nearest,
                           is_far ? afar : distance_to_line(next, from, from_seed(sign * std::min(i + stride, end))));
    }
    return nearest;
}

std::int32_t min_stroke_steps(const PlacementGrid& grid, const PlacementTexel& texel, std::int32_t crowded_ends) {
    const std::int32_t by_length = Streamline::target_steps(texel, grid.rules.min_length_share);
    const std::int32_t by_spacing = (1 + crowded_ends) * texel.spacing() >> k_spacing_bits;
    return std::max(std::min(by_length, by_spacing), k_min_steps);
}

}  // namespace exemplar
