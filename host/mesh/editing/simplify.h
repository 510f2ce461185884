#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "host/mesh/mesh.h"

namespace exemplar {

/// A simplified mesh and the mapping of the original's faces to its faces.
struct SimplifiedMesh {
    TriangleMesh mesh;
    std::vector<std::uint32_t> face_of;  ///< for each face of the original the face of `mesh` that represents it
};

/// Simplifies a mesh to about `faces` evenly spread faces; returns it unchanged if it has no more than these.
/// Clusters the vertices around seeds spread evenly over the area, which move to the cluster centers a few times
/// (after Valette and Chassery 2004). Clusters grow along edges, so that surfaces that merely lie close stay apart.
/// A cluster becomes the vertex that fits its planes best (Garland and Heckbert 1997); three clusters that meet in a
/// face become a face. Accepts any finite mesh, with all kinds of defects. Loose pieces smaller than a cluster
/// vanish, and their faces map to the nearest face. Deterministic. Throws MeshError if nothing would be left, as of
/// a soup of loose triangles.
SimplifiedMesh simplify_mesh(const TriangleMesh& mesh, std::size_t faces);

}  // namespace exemplar
