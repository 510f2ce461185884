#pragma once

#include <cstdint>
#include <vector>

#include "host/hatching/placement/clearance.h"
#include "host/hatching/placement/placement_grid.h"
#include "host/hatching/placement/stroke_way.h"

namespace exemplar {

/// A stroke that may be placed.
struct StrokeCandidate {
    FineStroke stroke;
    std::vector<FinePoint> way;   ///< what of its way was looked at: the stroke, and a little more at its ends
    std::uint32_t shortness = 0;  ///< 0 if it has three quarters of its target length or more; up to 3
};

/// Follows the stroke from a seed, a pixel that has strokes (StrokeWay). Where it ends by its length, with less room
/// before it than another stroke would need, it is moved up to what is there; with too little room for that at both
/// ends it takes all of it, or half where that were too long. Returns whether it is long enough
/// (StrokeOptions::least_length).
bool trace_stroke(const PlacementGrid& grid, const Clearance& clearance, const StrokeSeed& seed,
                  StrokeCandidate& candidate);

}  // namespace exemplar
