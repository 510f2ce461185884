#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "host/mesh/mesh.h"

namespace exemplar {

/// Removes the faces that name a vertex twice; the others keep their source faces. Returns the number of removed faces.
std::size_t remove_collapsed_faces(TriangleMesh& mesh);

/// A mesh prepared for drawing: coincident vertices are merged, faces that name a vertex twice are removed, and the
/// others are oriented outwards.
struct DrawableMesh {
    TriangleMesh mesh;
    std::vector<std::string> warnings;  ///< what was changed, except merged vertices; a line each
};
/// Prepares a mesh for drawing. Throws MeshError naming `name` if the mesh is empty or not finite, or no face is left.
DrawableMesh drawable_mesh(const TriangleMesh& mesh, const std::string& name);

}  // namespace exemplar
