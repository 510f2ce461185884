#pragma once

#include <cstddef>
#include <vector>

#include "host/mesh/mesh.h"

namespace exemplar {

/// Removes the faces that are marked in `is_removed` (one entry a face); the others keep their order and their source
/// faces. Returns the number of removed faces; a mesh that loses none stays as it is.
std::size_t remove_faces(TriangleMesh& mesh, const std::vector<bool>& is_removed);

/// Removes the faces that name a vertex twice. Returns the number of removed faces.
std::size_t remove_collapsed_faces(TriangleMesh& mesh);

}  // namespace exemplar
