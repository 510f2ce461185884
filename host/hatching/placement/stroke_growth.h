#pragma once

#include <span>

#include "host/hatching/placement/placement_grid.h"

namespace exemplar {

/// Lengthens strokes that are shorter than new strokes would be (their target less its jitter), one after the other, at
/// their last point and then at their first: as far as new strokes would go, and no nearer to others of their layer, or
/// to what is not near along themselves, than the test distance. So strokes that a border has cut follow it when it
/// moves back.
void grow_strokes(const PlacementGrid& grid, std::span<FineStroke> strokes);

}  // namespace exemplar
