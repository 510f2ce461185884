#include "host/hatching/placement/placement_grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "host/core/errors.h"
#include "host/core/parallel.h"
#include "host/hatching/fields/field_sample.h"
#include "host/hatching/fields/occlusion_barriers.h"
#include "host/hatching/placement/clearance.h"

namespace exemplar {
namespace {

constexpr int k_max_picture = 32768;
constexpr float k_max_length = 1024;  // pixels
constexpr std::size_t k_max_candidate_points = std::size_t{1} << 22;
constexpr std::size_t k_min_candidates = 256, k_max_candidates = 16384;
constexpr std::uint32_t k_min_block_bits = 5;
/// Maximum distance in the clearance map, which stores ten bits.
constexpr std::int32_t k_max_near = 1000;

void check_field_sizes(const HatchingFields& fields, std::span<const std::uint8_t> barriers) {
    if (fields.width < 0 || fields.height < 0 || fields.width > k_max_picture || fields.height > k_max_picture)
        throw UsageError(fmt::format("strokes cannot be placed on {} x {} pixels; {} a side are the most", fields.width,
                                     fields.height, k_max_picture));
    const auto fits = [&](const auto& values) { return values.size() == fields.size(); };
    if (!fits(fields.level) || !fits(fields.orientation[0]) || !fits(fields.orientation[1]) ||
        !fits(fields.thickness) || !fits(fields.intensity) || !fits(fields.spacing) || !fits(fields.length))
        throw UsageError(fmt::format("the targets of a hatching of {} x {} pixels are not of that size", fields.width,
                                     fields.height));
    if (!barriers.empty() && barriers.size() != fields.size())
        throw UsageError(
            fmt::format("there are barriers for {} pixels and targets for {}; give as many, or no barriers",
                        barriers.size(), fields.size()));
}

void check_options(const StrokeOptions& o) {
    constexpr float k_right_angle = std::numbers::pi_v<float> / 2;
    const auto check = [](bool valid, const char* name, float value, const char* range) {
        if (!valid) throw UsageError(fmt::format("{} is {}; give a number {}", name, value, range));
    };
    check(o.test_distance > 0 && o.test_distance < 1, "the test distance", o.test_distance, "between 0 and 1");
    check(o.min_length >= 0 && o.min_length <= 1, "the least length", o.min_length, "from 0 to 1");
    check(o.length_jitter >= 0 && o.length_jitter <= 0.5f, "the jitter of lengths", o.length_jitter, "from 0 to 0.5");
    check(o.max_turn > 0 && o.max_turn <= k_right_angle, "the sharpest turn", o.max_turn, "over 0, up to pi / 2");
    check(o.length_hysteresis >= 0 && std::isfinite(o.length_hysteresis), "the hysteresis of lengths",
          o.length_hysteresis, "that is finite and not negative");
    check(o.max_deviation > 0 && o.max_deviation <= k_right_angle, "the deviation of kept strokes", o.max_deviation,
          "over 0, up to pi / 2");
}

void check_target(const HatchingFields& fields, std::size_t pixel, const char* name, float value, float most) {
    if (value >= 0 && value <= most && std::isfinite(value)) return;
    const auto row = static_cast<std::size_t>(fields.width);
    throw UsageError(
        fmt::format("the {} of the hatching at pixel ({}, {}) is {}; targets are finite and not negative{}", name,
                    pixel % row, pixel / row, value, most == 1 ? ", and none is over 1" : ""));
}

void check_pixel(const HatchingFields& fields, std::size_t i) {
    constexpr float k_any = std::numeric_limits<float>::max();
    if (fields.level[i] > k_cross_hatching)
        throw UsageError(fmt::format("there is no hatching level {}; levels are 0, 1 and 2", fields.level[i]));
    check_target(fields, i, "thickness", fields.thickness[i], k_any);
    check_target(fields, i, "intensity", fields.intensity[i], 1);
    check_target(fields, i, "spacing", fields.spacing[i], k_any);
    check_target(fields, i, "length", fields.length[i], k_any);
    for (std::size_t layer = 0; layer < fields.level[i]; ++layer)
        if (!std::isfinite(fields.orientation[layer][i]))
            throw UsageError(fmt::format("an orientation of the hatching is {}; orientations are finite",
                                         fields.orientation[layer][i]));
}

/// Clamps a value and rounds it to units of 1 / 2^bits.
std::uint32_t rounded(float value, float low, float high, int bits) {
    return static_cast<std::uint32_t>(std::lround(std::clamp(value, low, high) * static_cast<float>(1 << bits)));
}

std::uint32_t packed_direction(float orientation) {
    const auto half_word = [](float value) {
        return static_cast<std::uint32_t>(std::lround(value * k_unit)) & 0xffffU;
    };
    return half_word(std::cos(2 * orientation)) | half_word(std::sin(2 * orientation)) << 16;
}

PlacementTexel texel_of(const HatchingFields& fields, std::size_t i, std::uint8_t barriers) {
    PlacementTexel texel;
    texel.flags = barriers;
    if (fields.level[i] == k_no_hatching) return texel;
    check_pixel(fields, i);
    for (std::size_t layer = 0; layer < fields.level[i]; ++layer)
        texel.directions[layer] = packed_direction(fields.orientation[layer][i]);
    const std::uint32_t length = rounded(fields.length[i], 0, k_max_length, k_length_bits);
    texel.sizes = rounded(fields.spacing[i], 1, k_max_spacing, k_spacing_bits) | length << 16;
    return texel;
}

std::int32_t share(float value) {
    return static_cast<std::int32_t>(std::lround(value * (1 << k_share_bits)));
}

PlacementRules rules_of(const StrokeOptions& options) {
    PlacementRules rules;
    rules.seed =
        scatter(static_cast<std::uint32_t>(options.seed) ^ scatter(static_cast<std::uint32_t>(options.seed >> 32)));
    rules.test_share = share(options.test_distance);
    // A stroke fits into a gap of two test distances, as its seed is one away from either side; the extra 7% let it
    // go on. Gaps between that width and one spacing stay: they are as often too wide as others are too narrow.
    rules.hole_share = share(1.07f * options.test_distance);
    rules.min_length_share = share(options.min_length);
    rules.jitter = share(options.length_jitter);
    rules.min_turn_cosine = static_cast<std::int32_t>(std::lround(std::cos(options.max_turn) * k_unit));
    return rules;
}

/// Derives the limits from the largest targets.
void set_limits(PlacementGrid& grid) {
    std::int32_t spacing = 0, length = 0;
    for (const PlacementTexel& texel : grid.texels) {
        spacing = std::max(spacing, texel.spacing());
        length = std::max(length, texel.length());
    }
    PlacementRules& rules = grid.rules;
    rules.near_shift = 4;
    while (clearance_radius(spacing) >> rules.near_shift > k_max_near) ++rules.near_shift;
    const std::int32_t longest = length * ((1 << k_share_bits) + rules.jitter) >> (k_share_bits + k_length_bits);
    // Tracing looks ahead at both ends, over a gap and three spacings at most.
    const std::int32_t ahead = 4 * (spacing >> k_spacing_bits) + k_min_steps + 6;
    rules.room = static_cast<std::uint32_t>(longest + 2 * ahead);
    rules.candidates =
        static_cast<std::uint32_t>(std::clamp(k_max_candidate_points / rules.room, k_min_candidates, k_max_candidates));
    rules.block_bits = k_min_block_bits;
    const auto blocks = [&](int size) { return ((size - 1) >> rules.block_bits) + 1; };
    while (grid.size() > 0 && static_cast<std::size_t>(blocks(grid.width)) *
                                      static_cast<std::size_t>(blocks(grid.height)) * k_hatch_layers >
                                  rules.candidates)
        ++rules.block_bits;
}

HatchStroke finished(const FineStroke& stroke, const HatchingFields& fields) {
    HatchStroke result{.layer = stroke.layer, .points = {}, .widths = {}, .darkness = 0};
    const std::size_t count = stroke.points.size();
    for (std::size_t i = 0; i < count; i += i + 2 < count || i + 1 == count ? 2 : 1) {
        const FinePoint& point = stroke.points[i];
        result.points.emplace_back(static_cast<float>(point.x) / k_pixel, static_cast<float>(point.y) / k_pixel);
        result.widths.push_back(sample_hatched(fields, fields.thickness, result.points.back()));
        result.darkness += sample_hatched(fields, fields.intensity, result.points.back());
    }
    result.darkness /= static_cast<float>(result.points.size());
    return result;
}

}  // namespace

PlacementGrid make_placement_grid(const HatchingFields& fields, std::span<const std::uint8_t> barriers,
                                  const StrokeOptions& options) {
    check_field_sizes(fields, barriers);
    check_options(options);
    PlacementGrid grid{.width = fields.width, .height = fields.height, .texels = {}, .rules = rules_of(options)};
    grid.texels.resize(fields.size());
    parallel_for(
        grid.size(),
        [&](std::size_t i) { grid.texels[i] = texel_of(fields, i, barriers.empty() ? std::uint8_t{0} : barriers[i]); },
        4096);
    set_limits(grid);
    return grid;
}

bool is_free_step(const PlacementGrid& grid, FinePoint from, FinePoint to) {
    const int x = from.x >> k_pixel_bits, y = from.y >> k_pixel_bits;
    const int next_x = to.x >> k_pixel_bits, next_y = to.y >> k_pixel_bits;
    const auto free_along = [&](int row) {
        return x == next_x || !(grid.at(std::min(x, next_x), row).flags & k_barrier_right);
    };
    const auto free_down = [&](int column) {
        return y == next_y || !(grid.at(column, std::min(y, next_y)).flags & k_barrier_below);
    };
    return (free_along(y) && free_down(next_x)) || (free_down(x) && free_along(next_y));
}

std::vector<HatchStroke> finished_strokes(std::span<const FineStroke> strokes, const HatchingFields& fields) {
    std::vector<HatchStroke> result(strokes.size());
    parallel_for(
        strokes.size(), [&](std::size_t i) { result[i] = finished(strokes[i], fields); }, 32);
    return result;
}

}  // namespace exemplar
