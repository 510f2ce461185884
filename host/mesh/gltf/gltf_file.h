#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace tinygltf {
class Model;
}

namespace exemplar::mesh_io {

/// What is kept of a glTF file: triangles, nodes, skins, morph targets and material names; or also animations.
enum class GltfContent { still, animation };

/// Loads glTF 2.0 (.gltf or .glb, told apart by content) through tinygltf. The library trusts parts of its input
/// (chunk lengths, deep nesting), so the file is first checked and cut down to the `wanted` content, and its buffers
/// are read here (read_gltf_buffers). The result must be checked again before it is used (GltfReader). Throws MeshError
/// that begins with `name`.
tinygltf::Model load_gltf(std::string_view content, const std::string& name, const std::filesystem::path& folder,
                          GltfContent wanted);

/// Returns the bytes of a .glb file with this JSON chunk and binary chunk.
std::string binary_gltf(std::string json, std::string_view binary);

}  // namespace exemplar::mesh_io
