#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "host/mesh/mesh.h"

namespace exemplar {

struct SplitOptions {
    bool caps = false;  ///< whether the cuts are closed (see make_caps)
};

/// One part of a mesh.
struct PartMesh {
    TriangleMesh mesh;  ///< triangles in the order of the original, then caps; in the original's frame (origin)
    std::vector<std::uint32_t> face_of;  ///< per triangle that of the original; k_invalid_index in a cap
    std::size_t cap_faces = 0;
};

struct SplitMesh {
    std::vector<PartMesh> parts;  ///< one per part number, some may be without faces
    std::size_t caps = 0;         ///< surfaces that two parts share
    std::size_t cap_centers = 0;  ///< caps that needed a vertex in their middle
    /// Edges of cuts that could not be closed, since the cut ends at a boundary or a non-manifold edge of the mesh.
    std::size_t open_edges = 0;
};

/// Splits a mesh into parts. `part_of_face`: a number below `part_count` per triangle. Vertices that parts share are
/// copied; their coordinates are equal to the last bit. With caps, each part of a closed, consistently oriented mesh
/// whose edges have two faces is closed, its edges have two faces, and the triangles at each vertex form one fan (so a
/// vertex where a part only touches itself becomes two). Throws UsageError for sizes or numbers that do not fit.
SplitMesh split_mesh(const TriangleMesh& mesh, std::span<const std::uint32_t> part_of_face, std::size_t part_count,
                     const SplitOptions& options = {});

/// Moves each part away from the middle of all parts, along the line between the centers of their boxes: by `share` of
/// the diagonal of the whole for the part farthest out, by proportionally less for others.
void explode_parts(std::span<PartMesh> parts, double share);

}  // namespace exemplar
