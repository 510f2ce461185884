#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "host/hatching/placement/stroke_way.h"

namespace exemplar {

/// What places that strokes are tried at are taken from.
enum class SeedSource : std::uint32_t {
    part,        ///< places in the middle of a part of the picture, one of which will do
    left_side,   ///< beside a stroke, from both sides of which one after the other is tried
    right_side,  ///< the same
    first_end,   ///< in line with a stroke, behind a gap
    last_end,    ///< the same
    block,       ///< holes within a square block of pixels
};

/// Places that are tried one after the other, as long as there are any.
struct SeedList {
    SeedSource source = SeedSource::part;
    std::uint32_t layer = 0;
    /// Of a stroke its first point, among those of all strokes, and the number of its points; else where the middle
    /// of the part is, or the block's upper left pixel.
    std::uint32_t first = 0, second = 0;
    std::uint32_t next = 0;  ///< which place is tried next
};

/// Where the strokes of each layer begin: in each part of the picture that can be walked through from pixel to pixel
/// without meeting a barrier, the end of the layer or a turn of its directions by over 30 degrees, the pixel nearest to
/// the middle of the part. Parts that hold a point of a stroke in `kept` have none, nor those of less than nine squares
/// of one spacing a side.
std::vector<SeedList> first_seeds(const PlacementGrid& grid, std::span<const FineStroke> kept);

/// One per block of the picture and layer, unless nothing in it is hatched.
std::vector<SeedList> block_seeds(const PlacementGrid& grid);

/// What a new stroke adds to the front: its two sides and its two ends.
std::array<SeedList, 4> stroke_seeds(std::uint32_t layer, std::uint32_t first, std::uint32_t count);

/// How many places a list has.
std::uint32_t seed_count(const PlacementGrid& grid, const SeedList& list);

/// The i-th place of a list, if a stroke may begin there: it is hatched and far enough from all strokes, and seen from
/// the stroke that the list is of, strokes go the same way there. `points` are those of all strokes.
std::optional<StrokeSeed> seed_at(const PlacementGrid& grid, const Clearance& clearance,
                                  std::span<const FinePoint> points, const SeedList& list, std::uint32_t i);

}  // namespace exemplar
