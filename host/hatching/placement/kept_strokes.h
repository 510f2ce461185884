#pragma once

#include <span>
#include <vector>

#include "host/hatching/placement/clearance.h"
#include "host/hatching/placement/placement_grid.h"

namespace exemplar {

/// What remains of strokes of the picture before, and notes it in `clearance`; one after the other, in their order. Of
/// each the longest part that its layer has strokes along, in about its direction (StrokeOptions::most_deviation),
/// without a barrier, and far enough from all before; cut on both ends to its target length, unless it is over that by
/// no more than the hysteresis. It is left out where it is shorter than new strokes may be. At last they
/// grow back where there is room (see grow_strokes). Throws UsageError for
/// strokes that are not finite or of no layer.
std::vector<FineStroke> keep_strokes(const PlacementGrid& grid, std::span<const HatchStroke> strokes,
                                     const StrokeOptions& options, Clearance& clearance);

}  // namespace exemplar
