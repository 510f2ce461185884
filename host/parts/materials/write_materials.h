#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "host/parts/materials/material_table.h"
#include "host/parts/rigging/part_graph.h"

namespace exemplar {

/// Writes binary glTF 2.0 with a primitive and a material per label that occurs among the parts, normals, and texture
/// coordinates per part (see project_part). Images are embedded. The names of materials are those of the labels, so
/// that read_mesh finds the labels again. Throws DataError for a texture that is neither PNG nor JPEG or cannot be
/// read, MeshError if the mesh is too large.
void write_materials(const std::filesystem::path& path, const TriangleMesh& mesh, const PartGraph& graph,
                     const std::vector<std::string>& names, const MaterialTable& materials);

}  // namespace exemplar
