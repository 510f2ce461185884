#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "host/mesh/gltf/gltf_buffers.h"

namespace exemplar::mesh_io {

/// A glTF file as it is, with all that applications and extensions added; only compressed geometry is expanded.
struct GltfDocument {
    nlohmann::json json;
    GltfBuffers buffers;
};

/// Reads a .gltf or .glb file. Checks that it is of version 2 and needs no unknown extension of geometry, not what the
/// JSON tells. Throws MeshError that begins with `name`.
GltfDocument read_gltf_document(std::string_view content, const std::string& name, const std::filesystem::path& folder);

/// Puts all buffers, `appended` and the images in files beside the document into one buffer, and returns the .glb file.
/// Each string of `appended` gets a buffer view, in order behind those of the document. Leaves an image whose file
/// cannot be read as it is, with a line in `warnings`. Throws MeshError that begins with `name` if the result is larger
/// than 4 GiB, or a view names no buffer.
std::string binary_of_document(GltfDocument document, std::span<const std::string> appended, const std::string& name,
                               const std::filesystem::path& folder, std::vector<std::string>& warnings);

}  // namespace exemplar::mesh_io
