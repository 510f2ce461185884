#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace exemplar::mesh_io {

/// The bytes of each buffer of a glTF file, in its order.
using GltfBuffers = std::vector<std::vector<unsigned char>>;

/// Maximum size of all buffers of a glTF file together, and of the file itself, in bytes (2 GiB).
extern const std::uint64_t k_max_gltf_bytes;

/// Reads as many bytes of each buffer as the JSON declares (`byteLength`): from `binary` (the binary chunk, for the
/// first buffer without an address), from data URIs (base64 or percent-encoded, of any media type), or from files in
/// `folder` that no link leads out of. Sources may be longer than declared, and serve several buffers. A buffer that
/// only decoders without EXT_meshopt_compression need is empty. Throws MeshError that begins with `name`.
GltfBuffers read_gltf_buffers(const nlohmann::json& document, std::string_view binary, const std::string& name,
                              const std::filesystem::path& folder);

/// Reads a whole file that a glTF file in `folder` names, such as an image, under the same conditions. Throws MeshError
/// that begins with `name`.
std::vector<unsigned char> read_gltf_resource(std::string_view uri, const std::string& name,
                                              const std::filesystem::path& folder);

/// Returns the total size of the files that the JSON of a .gltf file declares as buffers, at most k_max_gltf_bytes.
std::uint64_t external_bytes_of(const nlohmann::json& document);

}  // namespace exemplar::mesh_io
