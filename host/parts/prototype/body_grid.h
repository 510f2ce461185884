#pragma once

#include "host/mesh/mesh.h"
#include "host/parts/prototype/level_surface.h"

namespace exemplar {

/// How far from the surface body_distances are exact, in cells.
constexpr float k_body_reach = 3;

/// Returns the signed distances to a closed mesh, negative inside, at a grid that reaches `margin` beyond its bounding
/// box. Values are exact near the surface, and clamped to `k_body_reach` cells elsewhere.
ValueGrid body_distances(const TriangleMesh& mesh, float cell, float margin);

/// Returns the value at a point, linear between nodes; the border's value outside of the grid.
float value_at(const ValueGrid& grid, const Vec3& point);

}  // namespace exemplar
