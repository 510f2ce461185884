#pragma once

#include <cstdint>

#include "host/hatching/placement/placement_grid.h"

namespace exemplar {

/// Returns the direction of a layer's strokes at a point, with the sign nearer to `heading`. Vectors of the doubled
/// angle are interpolated bilinearly between those of the four pixels around the point that are hatched and
/// reachable from the point's own pixel without a barrier. Returns none if that pixel is not hatched or the
/// directions cancel out.
Direction direction_at(const PlacementGrid& grid, std::uint32_t layer, FinePoint point, Direction heading);

}  // namespace exemplar
