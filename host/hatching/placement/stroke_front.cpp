#include "host/hatching/placement/stroke_front.h"

#include <algorithm>
#include <bit>

#include "host/hatching/placement/stroke_directions.h"

namespace exemplar {
namespace {

/// Cosine of the maximum angle between a stroke and a seed beside it or in line with it (45 degrees), times k_unit.
constexpr std::int32_t k_side_cosine = 11585;
/// A stroke has seeds beside every second point.
constexpr std::uint32_t k_side_stride = 2;

/// Returns the i-th number of a permutation of [0, 2^bits): bit-reversed counting that starts at `chance`.
std::uint32_t scattered(std::uint32_t i, int bits, std::uint32_t chance) {
    return reversed_bits(i, bits) ^ (chance & ((1U << bits) - 1));
}

/// Returns the even bits of a word, packed together.
std::uint32_t every_second_bit(std::uint32_t word) {
    std::uint32_t result = 0;
    for (int i = 0; i < 16; ++i) result |= (word >> (2 * i) & 1U) << i;
    return result;
}

std::uint32_t sides_of(const SeedQueue& list) {
    return (list.second + k_side_stride - 1) / k_side_stride;
}
int bits_of(std::uint32_t count) {
    return std::bit_width(count - 1);
}

/// Returns a seed at a point that is hatched and at least `share` of the spacing there away from all strokes.
std::optional<StrokeSeed> clear_seed(const PlacementGrid& grid, const Clearance& clearance, std::uint32_t layer,
                                     FinePoint at, std::int32_t share, Direction heading) {
    const PlacementTexel* texel = grid.at(at);
    if (!texel || !texel->hatched(layer) || !clearance.is_clear(layer, at, texel->spacing(), share)) return {};
    const Direction way = direction_at(grid, layer, at, heading);
    if (!way) return {};
    return StrokeSeed{layer, at, way};
}

/// Returns the same if the field there also runs in about the direction `heading` of a neighboring stroke.
std::optional<StrokeSeed> parallel_seed(const PlacementGrid& grid, const Clearance& clearance, std::uint32_t layer,
                                        FinePoint at, Direction heading) {
    auto seed = clear_seed(grid, clearance, layer, at, grid.rules.test_share, heading);
    if (seed && dot(seed->heading, heading) < k_side_cosine * k_unit) seed.reset();
    return seed;
}

/// Returns the offset by a spacing along a direction.
FinePoint times(Direction direction, std::int32_t spacing) {
    constexpr int k_shift = k_unit_bits - k_pixel_bits + k_spacing_bits;
    constexpr std::int32_t k_half = 1 << (k_shift - 1);
    return {(direction.x * spacing + k_half) >> k_shift, (direction.y * spacing + k_half) >> k_shift};
}

/// A seed one spacing beside a stroke: the mean of the spacings at both ends of the offset.
std::optional<StrokeSeed> side_seed(const PlacementGrid& grid, const Clearance& clearance,
                                    std::span<const FinePoint> points, const SeedQueue& list, std::uint32_t i) {
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

/// A seed in line with a stroke, a little over the test distance from its end.
std::optional<StrokeSeed> end_seed(const PlacementGrid& grid, const Clearance& clearance,
                                   std::span<const FinePoint> points, const SeedQueue& list) {
    constexpr std::int32_t k_margin = 1 << (k_spacing_bits - 1);
    const bool is_first = list.source == SeedSource::first_end;
    const std::uint32_t tip = is_first ? list.first : list.first + list.second - 1;
    const FinePoint way = points[tip] - points[is_first ? tip + 1 : tip - 1];
    const Direction heading = direction_of(way.x, way.y);
    const std::int32_t gap = (grid.at(points[tip])->spacing() * grid.rules.test_share >> k_share_bits) + k_margin;
    return parallel_seed(grid, clearance, list.layer, points[tip] + times(heading, gap), heading);
}

/// A seed at the center of a pixel of a block, farther from all strokes than regular gaps allow.
std::optional<StrokeSeed> hole_seed(const PlacementGrid& grid, const Clearance& clearance, const SeedQueue& list,
                                    std::uint32_t i) {
    const auto bits = static_cast<int>(2 * grid.rules.block_bits);
    const std::uint32_t chance = scatter(list.first ^ scatter(list.second ^ grid.rules.seed));
    const std::uint32_t place = scattered(i, bits, chance);
    const int x = static_cast<int>(list.first + every_second_bit(place));
    const int y = static_cast<int>(list.second + every_second_bit(place >> 1));
    const FinePoint at{x * k_pixel + k_pixel / 2, y * k_pixel + k_pixel / 2};
    return clear_seed(grid, clearance, list.layer, at, grid.rules.hole_share, {k_unit, 0});
}

/// A seed at the middle of a part; then, as directions may cancel out there, at random places in squares around it
/// whose side grows by a spacing each time.
std::optional<StrokeSeed> part_seed(const PlacementGrid& grid, const Clearance& clearance, const SeedQueue& list,
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

std::array<SeedQueue, 4> stroke_seeds(std::uint32_t layer, std::uint32_t first, std::uint32_t count) {
    std::array<SeedQueue, 4> lists;
    for (std::uint32_t i = 0; i < 4; ++i)
        lists[i] = {static_cast<SeedSource>(static_cast<std::uint32_t>(SeedSource::left_side) + i), layer, first, count,
                    0};
    return lists;
}

std::uint32_t seed_count(const PlacementGrid& grid, const SeedQueue& list) {
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
                                  std::span<const FinePoint> points, const SeedQueue& list, std::uint32_t i) {
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
