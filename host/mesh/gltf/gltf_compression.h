#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "host/mesh/gltf/gltf_buffers.h"

namespace exemplar::mesh_io {

/// Decodes the compressed parts of a glTF file (buffer views by EXT_meshopt_compression, primitives by
/// KHR_draco_mesh_compression), appends them to `buffers`, and changes `document` into the JSON of a file without these
/// extensions. Decoded counts must be those of the JSON; before anything is decoded they are compared with the
/// size of the compressed bytes. Throws MeshError that begins with `name`.
void expand_compressed(nlohmann::json& document, GltfBuffers& buffers, const std::string& name);

}  // namespace exemplar::mesh_io
