#pragma once

#include <span>

#include "host/hatching/placement/placement_grid.h"

namespace exemplar {

/// Extends strokes that are shorter than new strokes would be (their target length less its jitter), one after the
/// other, at their last point and then at their first. A stroke grows as far as new strokes would go, and no nearer
/// than the test distance to others of its layer or to distant parts of itself. Strokes that a border has cut thus
/// follow it when it moves back.
void grow_strokes(const PlacementGrid& grid, std::span<FineStroke> strokes);

}  // namespace exemplar
