#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "host/mesh/editing/orient_faces.h"
#include "host/mesh/mesh.h"

namespace exemplar {

/// Appends a line for the faces that merge_coincident_faces removed.
void warn_of_coincident_faces(std::size_t removed, std::vector<std::string>& warnings);
/// Appends a line for the faces that were turned to agree with others, and one for the pieces that were inside out.
void warn_of_turned_faces(const OrientationChange& change, std::vector<std::string>& warnings);

/// A mesh prepared for drawing: coincident vertices are merged, faces that name a vertex twice are removed, and the
/// others are oriented consistently and outward (see orient_faces).
struct DrawableMesh {
    TriangleMesh mesh;
    std::vector<std::string> warnings;  ///< what was changed, except merged vertices; a line each
};
/// Prepares a mesh for drawing. Throws MeshError naming `name` if the mesh is empty or not finite, or no face is left.
DrawableMesh drawable_mesh(const TriangleMesh& mesh, const std::string& name);

}  // namespace exemplar
