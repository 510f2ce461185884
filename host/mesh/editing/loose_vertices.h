#pragma once

#include <cstdint>
#include <vector>

#include "host/mesh/mesh.h"

namespace exemplar {

/// The vertices that faces have, in their order.
std::vector<std::uint32_t> vertices_of_faces(const TriangleMesh& mesh);

/// The mesh with those vertices alone. Others are not part of the surface, and may be anywhere.
TriangleMesh without_loose_vertices(const TriangleMesh& mesh);

}  // namespace exemplar
