#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "host/mesh/mesh.h"

namespace exemplar {

/// Triangulates a closed polygon in space, which need not be planar, without new vertices. Minimizes the area plus a
/// small multiple of the squared lengths of the edges, by dynamic programming over sub-polygons (Barequet and Sharir
/// 1995, Filling gaps in the boundary of a polyhedron; Liepa 2003, Filling holes in meshes). `inward` has for each
/// side, from vertex i to i + 1, a unit vector into the solid: triangles on that side that run along its surface or out
/// of it cost more. It may be empty. A polygon of more than 256 vertices is divided into 128 pieces first, each
/// triangulated alone. `may_join(i, j)` tells whether an inner edge may join the vertices i and j. Returns triangles of
/// indices into `points` in the polygon's orientation; nothing if no triangulation is allowed.
std::optional<std::vector<Face>> triangulate_loop(std::span<const Vec3> points, std::span<const Vec3> inward,
                                                  const std::function<bool(std::uint32_t, std::uint32_t)>& may_join);

}  // namespace exemplar
