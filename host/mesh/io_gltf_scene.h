#pragma once

#include <string>

#include "host/mesh/io.h"

namespace tinygltf {
class Model;
}

namespace exemplar::mesh_io {

/// All triangles of the default scene in one mesh, transformed by their nodes, vertices welded by exact position.
/// Material names become labels if Exemplar wrote the file. Throws MeshError if an index or length leads nowhere.
MeshFile mesh_of_gltf(const tinygltf::Model& model, const std::string& name);

}  // namespace exemplar::mesh_io
