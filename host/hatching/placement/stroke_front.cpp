#include "host/hatching/placement/stroke_front.h"

#include <algorithm>
#include <bit>

#include "host/hatching/placement/stroke_directions.h"

namespace exemplar {
namespace {

/// Strokes beside each other differ in direction by 45 degrees at most: the cosine, times k_unit.
constexpr std::int32_t k_side_cosine = 11585;
/// Every second point of a stroke has a place beside it.
constexpr std::uint32_t k_side_stride = 2;

/// The i-th of 2^bits numbers, the scattered one first; a bijection.
std::uint32_t scattered(std::uint32_t i, int bits, std::uint32_t chance) {
    return reversed_bits(i, bits) ^ (chance & ((1U << bits) - 1));
}

/// Every second bit of a word of which the others do not count, side by side.
std::uint32_t every_second_bit(std::uint32_t word) {
    std::uint32_t result = 0;
    for (int i = 0; i < 16; ++i) result |= (word >> (2 * i) & 1U) << i;
    return result;
}

std::uint32_t sides_of(const SeedList& list) {
    return (list.second + k_side_stride - 1) / k_side_stride;
}
int bits_of(std::uint32_t count) {
    return std::bit_width(count - 1);
}

/// The seed of a stroke at a place that has strokes and is so far from all, in shares of the spacing there.
std::optional<StrokeSeed> clear_seed(const PlacementGrid& grid, const Clearance& clearance, std::uint32_t layer,
                                     FinePoint at, std::int32_t share, Direction heading) {
    const PlacementTexel* texel = grid.at(at);
    if (!texel || !texel->hatched(layer) || !clearance.is_clear(layer, at, texel->spacing(), share)) return {};
    const Direction way = direction_at(grid, layer, at, heading);
    if (!way) return {};
    return StrokeSeed{layer, at, way};
}

/// The same beside or behind a stroke that goes in some direction; strokes go about the same way there.
std::optional<StrokeSeed> parallel_seed(const PlacementGrid& grid, const Clearance& clearance, std::uint32_t layer,
                                        FinePoint at, Direction heading) {
    auto seed = clear_seed(grid, clearance, layer, at, grid.rules.test_share, heading);
    if (seed && dot(seed->heading, heading) < k_side_cosine * k_unit) seed.reset();
    return seed;
}

/// A direction times a spacing, as a way.
FinePoint times(Direction direction, std::int32_t spacing) {
    constexpr int k_shift = k_unit_bits - k_pixel_bits + k_spacing_bits;
    constexpr std::int32_t k_half = 1 << (k_shift - 1);
    return {(direction.x * spacing + k_half) >> k_shift, (direction.y * spacing + k_half) >> k_shift};
}

/// One spacing off a stroke, the mean of those at both ends of the way.
std::optional<StrokeSeed> side_seed(const PlacementGrid& grid, const Clearance& clearance,
                                    std::span<const FinePoint> points, const SeedList& list, std::uint32_t i) {
    const std::uint32_t sides = sides_of(list);
    const std::uint32_t place = reversed_bits(i, bits_of(sides));
    if (place >= sides) return {};
    const std::uint32_t chance = scatter(list.first ^ grid.rules.seed);
    const std::uint32_t j = k_side_stride * ((place + chance % sides) % sides);
    const FinePoint point = points[list.first + j];
    const FinePoint way = points[list.first + std::min(j + 1, list.second - 1)] - points[list.first + (j ? j - 1 : 0)];
    const Direction heading = direction_of(way.x, way.y);
    const Direction off =
        list.source == SeedSource::left_side ? Direction{heading.y, -heading.x} : Direction{-heading.y, heading.x};
    const std::int32_t here = grid.at(point)->spacing();
    const PlacementTexel* there = grid.at(point + times(off, here));
    if (!there || !there->hatched(list.layer)) return {};
    return parallel_seed(grid, clearance, list.layer, point + times(off, (here + there->spacing()) / 2), heading);
}

/// In line with a stroke, a little over the test distance from its end.
std::optional<StrokeSeed> end_seed(const PlacementGrid& grid, const Clearance& clearance,
                                   std::span<const FinePoint> points, const SeedList& list) {
    constexpr std::int32_t k_margin = 1 << (k_spacing_bits - 1);
    const bool is_first = list.source == SeedSource::first_end;
    const std::uint32_t tip = is_first ? list.first : list.first + list.second - 1;
    const FinePoint way = points[tip] - points[is_first ? tip + 1 : tip - 1];
    const Direction heading = direction_of(way.x, way.y);
    const std::int32_t gap = (grid.at(points[tip])->spacing() * grid.rules.test_share >> k_share_bits) + k_margin;
    return parallel_seed(grid, clearance, list.layer, points[tip] + times(heading, gap), heading);
}

/// The middle of a pixel of a block that is farther from all strokes than gaps between them are wide.
std::optional<StrokeSeed> hole_seed(const PlacementGrid& grid, const Clearance& clearance, const SeedList& list,
                                    std::uint32_t i) {
    const auto bits = static_cast<int>(2 * grid.rules.block_bits);
    const std::uint32_t chance = scatter(list.first ^ scatter(list.second ^ grid.rules.seed));
    const std::uint32_t place = scattered(i, bits, chance);
    const int x = static_cast<int>(list.first + every_second_bit(place));
    const int y = static_cast<int>(list.second + every_second_bit(place >> 1));
    const FinePoint at{x * k_pixel + k_pixel / 2, y * k_pixel + k_pixel / 2};
    return clear_seed(grid, clearance, list.layer, at, grid.rules.hole_share, {k_unit, 0});
}

/// The middle of a part of the picture; then, as that may be where directions cancel out, places that chance chooses in
/// squares around it that grow by a spacing.
std::optional<StrokeSeed> part_seed(const PlacementGrid& grid, const Clearance& clearance, const SeedList& list,
                                    std::uint32_t i) {
    const FinePoint middle{static_cast<std::int32_t>(list.first), static_cast<std::int32_t>(list.second)};
    const std::uint32_t chance = scatter(list.first ^ scatter(list.second ^ scatter(grid.rules.seed ^ i)));
    const auto off = [&](std::uint32_t word) {
        const auto size =
            static_cast<std::int32_t>(i) * (grid.at(middle)->spacing() << (k_pixel_bits - k_spacing_bits));
        return size / 512 * (static_cast<std::int32_t>(word & 511U) - 256);
    };
    const FinePoint at = middle + FinePoint{off(chance), off(chance >> 9)};
    return clear_seed(grid, clearance, list.layer, at, grid.rules.test_share, {k_unit, 0});
}

}  // namespace

std::array<SeedList, 4> stroke_seeds(std::uint32_t layer, std::uint32_t first, std::uint32_t count) {
    std::array<SeedList, 4> lists;
    for (std::uint32_t i = 0; i < 4; ++i)
        lists[i] = {static_cast<SeedSource>(static_cast<std::uint32_t>(SeedSource::left_side) + i), layer, first, count,
                    0};
    return lists;
}

std::uint32_t seed_count(const PlacementGrid& grid, const SeedList& list) {
    switch (list.source) {
        case SeedSource::left_side:
        case SeedSource::right_side:
            return 1U << bits_of(sides_of(list));
        case SeedSource::block:
            return 1U << (2 * grid.rules.block_bits);
        case SeedSource::part:
            return 64;
        default:
            return 1;
    }
}

std::optional<StrokeSeed> seed_at(const PlacementGrid& grid, const Clearance& clearance,
                                  std::span<const FinePoint> points, const SeedList& list, std::uint32_t i) {
    switch (list.source) {
        case SeedSource::part:
            return part_seed(grid, clearance, list, i);
        case SeedSource::block:
            return hole_seed(grid, clearance, list, i);
        case SeedSource::left_side:
        case SeedSource::right_side:
            return side_seed(grid, clearance, points, list, i);
        default:
            return end_seed(grid, clearance, points, list);
    }
}

}  // namespace exemplar
