#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace tinygltf {
class Model;
}

namespace exemplar::mesh_io {

/// What of a glTF file is looked at: triangles, nodes and material names; or also skins, morph targets and animations.
enum class GltfContent { geometry, animation };

/// glTF 2.0 (.gltf or .glb, told apart by content) through tinygltf. The library trusts parts of its input (lengths of
/// binary chunks, deep nesting, many buffers that share one chunk), so a file is checked and cut down to what is wanted
/// before the library sees it; whatever the library returns must be checked again before it is used (GltfReader).
/// Buffers in files of their own are read from `folder` alone, and not through links that lead out of it; the library
/// opens no file. Throws MeshError that begins with `name`.
tinygltf::Model load_gltf(std::string_view content, const std::string& name, const std::filesystem::path& folder,
                          GltfContent wanted);

/// How many bytes the buffers have that lie in files of their own, by the JSON of a .gltf file. Throws MeshError.
std::uint64_t gltf_bytes_beside(std::string_view json, const std::string& name);

/// The bytes of a .glb file of a JSON chunk and a binary chunk.
std::string binary_gltf(std::string json, std::string_view binary);

}  // namespace exemplar::mesh_io
