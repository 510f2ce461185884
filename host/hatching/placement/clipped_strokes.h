#pragma once

#include <span>
#include <vector>

#include "host/hatching/placement/clearance.h"
#include "host/hatching/placement/placement_grid.h"

namespace exemplar {

/// Clips the previous frame's strokes to what is still valid, and records them in `clearance`. A stroke keeps its
/// longest run that (1) is hatched in its layer, (2) deviates from the field by at most
/// StrokeOptions::max_deviation, (3) crosses no barrier and (4) keeps the test distance to strokes clipped before
/// it. Runs longer than the target by more than its jitter and hysteresis are trimmed at both ends to the target
/// length; runs too short for a new stroke are dropped. Finally strokes grow where there is room (grow_strokes()).
/// Processed in input order, so the result is deterministic. Throws UsageError for strokes that are not finite or
/// whose layer does not exist.
std::vector<FineStroke> clip_strokes(const PlacementGrid& grid, std::span<const HatchStroke> strokes,
                                     const StrokeOptions& options, Clearance& clearance);

}  // namespace exemplar
