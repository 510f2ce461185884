#pragma once

#include <cstdint>

#include "host/hatching/clearance.h"
#include "host/hatching/placement_grid.h"

namespace exemplar {

/// The direction of a layer's strokes at a point, that one of both which is nearer to `heading`: bilinear, as cosine
/// and sine of the double angle, between those of the four pixels around it that have strokes and that the point's own
/// pixel reaches without a barrier. None if its pixel has none, or if they cancel out.
Direction direction_at(const PlacementGrid& grid, std::uint32_t layer, FinePoint point, Direction heading);

/// Where a stroke is tried, and the direction of strokes there.
struct StrokeSeed {
    std::uint32_t layer = 0;
    FinePoint point;
    Direction heading;
};

/// A stroke that may be placed.
struct StrokeCandidate {
    FineStroke stroke;
    std::vector<FinePoint> way;   ///< what of its way was looked at: the stroke, and a little more at its ends
    std::uint32_t shortness = 0;  ///< 0 if it has three quarters of its target length or more; up to 3
};

/// Follows the stroke from a seed, a pixel that has strokes: to one side up to a share of its target length that the
/// seed's hash chooses (so that neighbors do not end in line), to the other up to all of it, and where that ends early,
/// on at the first. Where it ends by its length, with less room before it than another stroke would need, it is moved
/// up to what is there; with too little room for that at both ends it takes all of it, or half where that were too
/// long. Returns whether it is long enough (StrokeOptions::least_length).
bool trace_stroke(const PlacementGrid& grid, const Clearance& clearance, const StrokeSeed& seed,
                  StrokeCandidate& candidate);

/// The least number of steps of a stroke around a pixel, of which other strokes end so many ends.
std::int32_t least_steps(const PlacementGrid& grid, const PlacementTexel& texel, std::int32_t crowded_ends);

}  // namespace exemplar
