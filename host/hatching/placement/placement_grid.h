#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "host/hatching/placement/fixed_point.h"
#include "host/hatching/fields/hatching_fields.h"
#include "host/hatching/placement/streamlines.h"

namespace exemplar {

constexpr float k_most_spacing = 256;  ///< pixels
constexpr int k_spacing_bits = 6;      ///< spacing is in units of 1/64 pixel
constexpr int k_length_bits = 2;       ///< lengths of strokes are in units of 1/4 pixel
/// Strokes are followed in steps of this many units, a pixel but for what rounding may add: one never skips a pixel.
constexpr std::int32_t k_step = k_pixel - 2;
constexpr std::int32_t k_least_steps = 2;  ///< of a stroke
/// Of a list of places, how many are looked at in a round: kernels must come to an end.
constexpr std::uint32_t k_most_places = 16384;

/// What the placement of strokes knows of a pixel.
struct PlacementTexel {
    /// Per layer the cosine (low half) and the sine of twice the orientation, times k_unit, signed; zero where the
    /// layer has no strokes.
    std::array<std::uint32_t, k_hatch_layers> directions{};
    std::uint32_t sizes = 0;  ///< spacing (low half) and length
    std::uint32_t flags = 0;  ///< k_barrier_right and k_barrier_below

    bool hatched(std::uint32_t layer) const { return directions[layer] != 0; }
    std::int32_t spacing() const { return static_cast<std::int32_t>(sizes & 0xffffU); }
    std::int32_t length() const { return static_cast<std::int32_t>(sizes >> 16); }
};

/// The choices of StrokeOptions, and what follows from sizes, in whole numbers; kernels get the same.
struct PlacementRules {
    std::uint32_t seed = 0;
    std::int32_t test_share = 0;         ///< of the spacing, that centers of strokes are apart
    std::int32_t hole_share = 0;         ///< of the spacing, that what strokes leave empty is from all of them
    std::int32_t least_share = 0;        ///< of its target, that a stroke is long
    std::int32_t jitter = 0;             ///< by what share of the target lengths differ
    std::int32_t least_turn_cosine = 0;  ///< between one step and the next, times k_unit
    std::int32_t near_shift = 0;         ///< distances to strokes are in units of 2^near_shift
    std::uint32_t room = 0;              ///< points that a stroke may have
    std::uint32_t candidates = 0;        ///< strokes that are tried at once, at most
    std::uint32_t block_bits = 0;        ///< holes are looked for in blocks of 2^block_bits pixels a side
};

/// Targets and barriers as the placement of strokes takes them.
struct PlacementGrid {
    int width = 0, height = 0;
    std::vector<PlacementTexel> texels;
    PlacementRules rules;

    bool inside(int x, int y) const { return x >= 0 && y >= 0 && x < width && y < height; }
    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
    }
    const PlacementTexel& at(int x, int y) const { return texels[index(x, y)]; }
    /// The texel that a point is in; null beyond the picture.
    const PlacementTexel* at(FinePoint point) const {
        const int x = point.x >> k_pixel_bits, y = point.y >> k_pixel_bits;
        return inside(x, y) ? &at(x, y) : nullptr;
    }
    std::size_t size() const { return texels.size(); }
};

/// Checks and rounds what a StrokePlacer is given; see there.
PlacementGrid make_placement_grid(const HatchingFields& fields, std::span<const std::uint8_t> barriers,
                                  const StrokeOptions& options);

/// Whether a step from one pixel to itself or one of the eight around it is free: along both other sides of the corner
/// that a diagonal one turns, barriers must be in its way to stop it.
bool is_free_step(const PlacementGrid& grid, FinePoint from, FinePoint to);

/// A share of a spacing, in the units of positions.
inline std::int32_t share_of_spacing(std::int32_t spacing, std::int32_t share) {
    return (spacing * share >> k_share_bits) << (k_pixel_bits - k_spacing_bits);
}

/// A stroke that is placed, in its order.
struct FineStroke {
    std::uint32_t layer = 0;
    std::vector<FinePoint> points;
    bool operator==(const FineStroke&) const = default;
};

/// Placed strokes as they are drawn: every second point and the last, their widths the thickness there, interpolated
/// between pixels that are hatched; darkness is the mean intensity along the stroke.
std::vector<HatchStroke> finished_strokes(std::span<const FineStroke> strokes, const HatchingFields& fields);

}  // namespace exemplar
