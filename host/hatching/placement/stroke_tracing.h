#pragma once

#include <cstdint>
#include <vector>

#include "host/hatching/placement/clearance.h"
#include "host/hatching/placement/placement_grid.h"
#include "host/hatching/placement/streamline_steps.h"

namespace exemplar {

/// A traced stroke that may be placed.
struct StrokeCandidate {
    FineStroke stroke;
    std::vector<FinePoint> way;   ///< the traced streamline: the stroke, and a little more at its ends
    std::uint32_t shortness = 0;  ///< 0 if it has three quarters of its target length or more; up to 3
};

/// Traces the stroke from a seed in a hatched pixel (Streamline). An end is free if another stroke fits between it
/// and the next obstacle. If one end is not free, the stroke is moved up to the obstacle there; if neither is, it
/// takes all of the streamline, or half if that is too long. Returns whether it is long enough
/// (StrokeOptions::min_length).
bool trace_stroke(const PlacementGrid& grid, const Clearance& clearance, const StrokeSeed& seed,
                  StrokeCandidate& candidate);

}  // namespace exemplar
