#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "host/hatching/placement/streamline_steps.h"

namespace exemplar {

/// The kind of places that a seed queue holds.
enum class SeedSource : std::uint32_t {
    part,        ///< around the middle of a part of the picture; one stroke is enough
    left_side,   ///< one spacing to the left of a stroke, along all of it
    right_side,  ///< likewise to the right
    first_end,   ///< in line with a stroke, a gap before its first point
    last_end,    ///< likewise behind its last point
    block,       ///< the pixels of a square block, to fill holes
};

/// A queue of places, tried one after the other until it is exhausted.
struct SeedQueue {
    SeedSource source = SeedSource::part;
    std::uint32_t layer = 0;
    /// For the sides and ends of a stroke: the index of its first point among the points of all strokes, and the
    /// number of its points. For a part: its middle (x, y). For a block: its upper left pixel (x, y).
    std::uint32_t first = 0, second = 0;
    std::uint32_t next = 0;  ///< index of the next place
};

/// Returns one list per part of a layer: a connected set of hatched pixels without barriers or direction changes of
/// over 30 degrees between neighbors. Its middle is the pixel nearest to its centroid. Parts that contain a point of
/// a stroke in `kept`, or are smaller than nine squares of one spacing a side, have no list.
std::vector<SeedQueue> first_seeds(const PlacementGrid& grid, std::span<const FineStroke> kept);

/// Returns one list per layer and block of the picture with hatched pixels.
std::vector<SeedQueue> block_seeds(const PlacementGrid& grid);

/// Returns the lists that a new stroke adds to the front: its two sides and its two ends.
std::array<SeedQueue, 4> stroke_seeds(std::uint32_t layer, std::uint32_t first, std::uint32_t count);

/// Returns the number of places of a list.
std::uint32_t seed_count(const PlacementGrid& grid, const SeedQueue& list);

/// Returns the i-th place of a list if a stroke may begin there: it is hatched, far enough from all strokes and, for
/// lists of a stroke, the field deviates by at most 45 degrees from the stroke's direction. `points`: of all
/// strokes.
std::optional<StrokeSeed> seed_at(const PlacementGrid& grid, const Clearance& clearance,
                                  std::span<const FinePoint> points, const SeedQueue& list, std::uint32_t i);

}  // namespace exemplar
