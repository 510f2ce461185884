#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "host/parts/splitting/cut_loops.h"

namespace exemplar {

/// A triangulated surface over a cut loop. It closes the loop's part, and its mirror image (corners in reverse order)
/// belongs to the part of the group's base loop.
struct Cap {
    std::vector<std::uint32_t> boundary;  ///< half-edges of the loop
    /// Triangles that face out of the loop's part. Vertices from the mesh's vertex_count() on are centers.
    std::vector<Face> faces;
    /// Per boundary half-edge the side of `faces` on it, 3 * face + corner; it leads in the opposite direction.
    std::vector<std::uint32_t> boundary_side;
    std::uint32_t part, base_part;
};

struct Caps {
    std::vector<Cap> caps;
    std::vector<Vec3> centers;  ///< vertices that caps add
};

/// Closes the loops. In each group the longest loop, the base, is closed by the mirror images of the caps of all
/// others. So the caps of all parts cancel, whatever the number of parts that meet: the volumes of the parts add up to
/// that of the mesh, and each cut edge lies on two triangles in every closed part. A loop between two parts gives one
/// cap that both have. Caps have the least area that triangulate_loop finds without an edge that exists already; where
/// there is none, triangles from the center of the loop.
Caps make_caps(const TriangleMesh& mesh, const HalfEdges& edges, std::span<const CutLoopGroup> groups);

}  // namespace exemplar
