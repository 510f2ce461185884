#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "host/lines/extraction/face_neighbors.h"
#include "host/mesh/mesh.h"

namespace exemplar {

/// A mesh cut open along its creases, so that normals and curvature on either side know nothing of the other: contours
/// of a box or a machine part are then those of its smooth sides, and do not wind about its edges.
struct SplitSurface {
    std::vector<Face> faces;            ///< as many, in the same order, of new vertices
    std::vector<std::uint32_t> source;  ///< of each new vertex the old one, which it lies at

    /// The old vertices' positions, for the new ones.
    std::vector<Vec3> positions(std::span<const Vec3> vertices) const;
};

/// Splits vertices where no way around them leads from face to face but across a crease, which is an edge whose faces
/// meet at more than `crease_angle` (radians) or of which there are not two. Throws UsageError if neighbors are not
/// those of the faces, MeshError if a face names a vertex that is not there.
SplitSurface split_at_creases(std::span<const Face> faces, std::span<const Vec3> vertices,
                              std::span<const FaceNeighbors> neighbors, float crease_angle);

}  // namespace exemplar
