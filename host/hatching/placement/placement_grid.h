#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "host/hatching/fields/hatching_fields.h"
#include "host/hatching/placement/fixed_point.h"
#include "host/hatching/placement/streamlines.h"

namespace exemplar {

constexpr float k_max_spacing = 256;  ///< pixels
constexpr int k_spacing_bits = 6;     ///< spacing is in units of 1/64 pixel
constexpr int k_length_bits = 2;      ///< lengths of strokes are in units of 1/4 pixel
/// Length of a tracing step, in units of positions: a pixel minus a margin for rounding, so that no step skips a
/// pixel.
constexpr std::int32_t k_step = k_pixel - 2;
constexpr std::int32_t k_min_steps = 2;  ///< minimum length of a stroke
/// Maximum number of seeds of a list that are tested in a round: it bounds the run time of a kernel.
constexpr std::uint32_t k_max_seeds_per_round = 16384;

/// Targets and barriers of a pixel, as integers.
struct PlacementTexel {
    /// Per layer, cosine (low half) and sine (high half) of twice the orientation, signed, times k_unit; zero where
    /// the layer is not hatched.
    std::array<std::uint32_t, k_hatch_layers> directions{};
    std::uint32_t sizes = 0;  ///< spacing (low half) and length (high half)
    std::uint32_t flags = 0;  ///< k_barrier_right and k_barrier_below

    bool hatched(std::uint32_t layer) const { return directions[layer] != 0; }
    std::int32_t spacing() const { return static_cast<std::int32_t>(sizes & 0xffffU); }
    std::int32_t length() const { return static_cast<std::int32_t>(sizes >> 16); }
};

/// StrokeOptions and limits derived from the targets, as integers; kernels get the same values.
struct PlacementRules {
    std::uint32_t seed = 0;
    std::int32_t test_share = 0;        ///< minimum distance between strokes, share of the spacing
    std::int32_t hole_share = 0;        ///< minimum distance of a hole from all strokes, share of the spacing
    std::int32_t min_length_share = 0;  ///< minimum length of a stroke, share of its target
    std::int32_t jitter = 0;            ///< random variation of lengths, share of the target
    std::int32_t min_turn_cosine = 0;   ///< minimum, from one step to the next, times k_unit
    std::int32_t near_shift = 0;        ///< distances in the clearance map are in units of 2^near_shift
    std::uint32_t room = 0;             ///< maximum number of points of a streamline
    std::uint32_t candidates = 0;       ///< maximum number of strokes tried in a round
    std::uint32_t block_bits = 0;       ///< holes are searched in blocks of 2^block_bits pixels a side
};

/// Input of stroke placement: targets and barriers per pixel, and the rules.
struct PlacementGrid {
    int width = 0, height = 0;
    std::vector<PlacementTexel> texels;
    PlacementRules rules;

    bool inside(int x, int y) const { return x >= 0 && y >= 0 && x < width && y < height; }
    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
    }
    const PlacementTexel& at(int x, int y) const { return texels[index(x, y)]; }
    /// Returns the texel that contains a point; null outside of the picture.
    const PlacementTexel* at(FinePoint point) const {
        const int x = point.x >> k_pixel_bits, y = point.y >> k_pixel_bits;
        return inside(x, y) ? &at(x, y) : nullptr;
    }
    std::size_t size() const { return texels.size(); }
};

/// Checks the arguments of StrokePlacer::place() and converts them to integers; throws as described there.
PlacementGrid make_placement_grid(const HatchingFields& fields, std::span<const std::uint8_t> barriers,
                                  const StrokeOptions& options);

/// Returns whether no barrier blocks a step from a pixel to itself or one of its eight neighbors. A diagonal step is
/// blocked only if both paths around the corner are.
bool is_free_step(const PlacementGrid& grid, FinePoint from, FinePoint to);

/// Returns a share of a spacing, in units of positions.
inline std::int32_t share_of_spacing(std::int32_t spacing, std::int32_t share) {
    return (spacing * share >> k_share_bits) << (k_pixel_bits - k_spacing_bits);
}

/// A placed stroke: its points in order.
struct FineStroke {
    std::uint32_t layer = 0;
    std::vector<FinePoint> points;
    bool operator==(const FineStroke&) const = default;
};

/// Converts placed strokes to what is drawn: every second point and the last one. Widths are the thickness there,
/// interpolated between hatched pixels; darkness is the mean intensity along the stroke.
std::vector<HatchStroke> finished_strokes(std::span<const FineStroke> strokes, const HatchingFields& fields);

}  // namespace exemplar
