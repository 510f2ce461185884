#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "host/lines/extraction/face_neighbors.h"
#include "host/mesh/mesh.h"

namespace exemplar {

/// Marks the edges that a surface is not smooth across (k_sharp_side): those of more than two faces, and those where
/// it cannot pass for a smooth one. The smooth surface through a regular polygon with sides h, which meet at an angle
/// of a, is off its sides by h a / 8; h is the larger height of both faces over the edge. The edge is sharp if this is
/// more than a four hundredth of the diagonal of the box around all faces, some two pixels of a picture that shows it
/// whole. At angles above `crease_angle` (radians) a third of that is enough; smaller ones are in the round ends of
/// finely cut surfaces, as ears and hooves. Throws
/// UsageError if neighbors are not those of the faces, MeshError if a face has a vertex that does not exist.
void mark_sharp_edges(std::span<const Face> faces, std::span<const Vec3> vertices, float crease_angle,
                      std::span<FaceNeighbors> neighbors);

/// A mesh cut open along its sharp edges, so that normals and curvature are not smoothed across them. Contours of a
/// box or a machine part are then those of its smooth sides, and do not wind about its edges.
struct SplitSurface {
    std::vector<Face> faces;            ///< same number and order, with new vertices
    std::vector<std::uint32_t> source;  ///< per new vertex: the old one at its position

    /// Returns the positions of the new vertices, given those of the old ones.
    std::vector<Vec3> positions(std::span<const Vec3> vertices) const;
};

/// Splits each vertex into one per group of its faces that are connected across edges that are not sharp. The first
/// group keeps the number of the vertex, so without sharp edges the mesh stays as it is. Throws as mark_sharp_edges.
SplitSurface split_at_sharp_edges(std::span<const Face> faces, std::size_t vertex_count,
                                  std::span<const FaceNeighbors> neighbors);

/// The sharp edges of a surface.
struct SharpEdges {
    std::vector<FaceNeighbors> neighbors;  ///< of the faces, with sharp edges marked
    std::optional<SplitSurface> split;     ///< the surface cut open along them; none if that changes nothing
};

/// Finds the sharp edges (mark_sharp_edges) and cuts the surface open along them.
SharpEdges find_sharp_edges(std::span<const Face> faces, std::span<const Vec3> vertices, float crease_angle);

}  // namespace exemplar
