#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "host/mesh/mesh.h"

namespace exemplar {

/// A mesh with fewer faces, and where the faces of the original went.
struct SimplifiedMesh {
    TriangleMesh mesh;
    std::vector<std::uint32_t> face_of;  ///< for each face of the original the face of `mesh` that stands for it
};

/// Simplifies a mesh to about `faces` evenly spread faces; one that has no more is returned as it is.
/// The vertices are clustered around seeds that are spread evenly over the area and moved to the centers of their
/// clusters a few times (after Valette and Chassery 2004); clusters grow along edges, so that surfaces that lie close
/// together stay apart. A cluster becomes a vertex where its planes meet best (Garland and Heckbert 1997), three
/// clusters that meet in a face become a face. Any finite mesh will do, with all kinds of defects; loose pieces smaller
/// than a cluster vanish, and their faces are assigned to what is nearest. Deterministic. Throws MeshError if nothing
/// would be left: a soup of loose triangles cannot be simplified.
SimplifiedMesh simplify_mesh(const TriangleMesh& mesh, std::size_t faces);

}  // namespace exemplar
