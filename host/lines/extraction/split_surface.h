#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "host/lines/extraction/face_neighbors.h"
#include "host/mesh/mesh.h"

namespace exemplar {

/// A mesh cut open along its creases, so that normals and curvature are not smoothed across them. Contours of a box
/// or a machine part are then those of its smooth sides, and do not wind about its edges.
struct SplitSurface {
    std::vector<Face> faces;            ///< same number and order, with new vertices
    std::vector<std::uint32_t> source;  ///< per new vertex: the old one at its position

    /// Returns the positions of the new vertices, given those of the old ones.
    std::vector<Vec3> positions(std::span<const Vec3> vertices) const;
};

/// Splits each vertex into one per group of its faces that are connected across edges other than creases. A crease
/// is an edge whose faces meet at more than `crease_angle` (radians) or which does not have two faces. Throws
/// UsageError if neighbors are not those of the faces, MeshError if a face has a vertex that does not exist.
SplitSurface split_at_creases(std::span<const Face> faces, std::span<const Vec3> vertices,
                              std::span<const FaceNeighbors> neighbors, float crease_angle);

}  // namespace exemplar
