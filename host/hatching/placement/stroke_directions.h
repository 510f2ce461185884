#pragma once

#include <cstdint>

#include "host/hatching/placement/placement_grid.h"

namespace exemplar {

/// The direction of a layer's strokes at a point, that one of both which is nearer to `heading`: bilinear, as cosine
/// and sine of the double angle, between those of the four pixels around it that have strokes and that the point's own
/// pixel reaches without a barrier. None if its pixel has none, or if they cancel out.
Direction direction_at(const PlacementGrid& grid, std::uint32_t layer, FinePoint point, Direction heading);

}  // namespace exemplar
