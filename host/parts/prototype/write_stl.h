#pragma once

#include <filesystem>

#include "host/mesh/mesh.h"

namespace exemplar {

/// Writes binary STL. Throws MeshError if the mesh has no faces or is not finite, DataError if it cannot be written.
void write_stl(const std::filesystem::path& path, const TriangleMesh& mesh);

}  // namespace exemplar
