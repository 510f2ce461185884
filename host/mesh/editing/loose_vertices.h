#pragma once

#include <cstdint>
#include <vector>

#include "host/mesh/mesh.h"

namespace exemplar {

/// Returns the vertices that faces refer to, in increasing order.
std::vector<std::uint32_t> vertices_of_faces(const TriangleMesh& mesh);

/// Returns the mesh without all other vertices, which are not part of the surface and may be anywhere.
TriangleMesh without_loose_vertices(const TriangleMesh& mesh);

}  // namespace exemplar
