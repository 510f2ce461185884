#include "host/mesh/gltf/gltf_file.h"

#include <fmt/format.h>
#include <tiny_gltf.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "host/core/json_text.h"
#include "host/mesh/gltf/gltf_buffers.h"
#include "host/mesh/gltf/gltf_compression.h"
#include "host/mesh/gltf/gltf_document.h"
#include "host/mesh/io/io_formats.h"
#include "host/mesh/io/io_text.h"
#include "host/mesh/io/io_write_text.h"

namespace exemplar::mesh_io {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

/// The two parts of a glTF file.
struct GltfChunks {
    std::string_view json, binary;
};

std::uint32_t little_endian_word(std::string_view content, std::size_t at) {
    std::uint32_t word;
    std::memcpy(&word, content.data() + at, sizeof(word));
    return word;
}

/// Finds the chunks of a .glb file and checks that they lie within it; skips chunks of other types.
GltfChunks binary_chunks(std::string_view content, const std::string& name) {
    constexpr std::size_t k_header_bytes = 12, k_chunk_header_bytes = 8;
    constexpr std::uint32_t k_json = 0x4E4F534A, k_bin = 0x004E4942;
    if (content.size() < k_header_bytes) fail(name, "byte 0: the file is too short for binary glTF");
    if (const std::uint32_t version = little_endian_word(content, 4); version != 2)
        fail(name, fmt::format("byte 4: binary glTF of version {} is not supported, only version 2", version));
    const std::uint32_t length = little_endian_word(content, 8);
    if (length > content.size())
        fail(name,
             fmt::format("byte 8: the file should have {} bytes, but has {}; it is cut off", length, content.size()));
    GltfChunks chunks;
    for (std::size_t at = k_header_bytes; at + k_chunk_header_bytes <= length;) {
        const std::uint32_t bytes = little_endian_word(content, at), type = little_endian_word(content, at + 4);
        at += k_chunk_header_bytes;
        if (bytes > length - at)
            fail(name,
                 fmt::format("byte {}: a chunk of {} bytes reaches past the end", at - k_chunk_header_bytes, bytes));
        if (type == k_json && chunks.json.empty()) chunks.json = content.substr(at, bytes);
        if (type == k_bin && chunks.binary.empty()) chunks.binary = content.substr(at, bytes);
        at += bytes;
    }
    if (chunks.json.empty()) fail(name, "byte 12: the file has no JSON chunk");
    return chunks;
}

/// Deep nesting would exhaust the stack of recursive readers; real files stay below 20 levels.
void check_depth(std::string_view json, const std::string& name) {
    constexpr int k_deepest = 64;
    int depth = 0;
    bool in_string = false;
    for (std::size_t i = 0; i < json.size(); ++i) {
        const char c = json[i];
        if (in_string && c == '\\')
            ++i;
        else if (c == '"')
            in_string = !in_string;
        else if (!in_string && (c == '{' || c == '['))
            ++depth;
        else if (!in_string && (c == '}' || c == ']'))
            --depth;
        if (depth > k_deepest) fail(name, fmt::format("byte {}: the JSON is nested too deep", i));
    }
}

Json parse_document(std::string_view text, const std::string& name) {
    check_depth(text, name);
    try {
        Json document = parse_json(text);
        if (!document.is_object()) fail(name, "the JSON of a glTF file must be an object");
        return document;
    } catch (const Json::parse_error& error) {
        fail(name, fmt::format("byte {}: the JSON is malformed or cut off", error.byte - 1));
    } catch (const Json::exception&) {
        fail(name, "the JSON has a number that is too large");
    }
}

/// Removes what applications and extensions add, but for the extensions that hold geometry.
void drop_extras(Json& value) {
    constexpr std::array k_kept{"EXT_mesh_gpu_instancing", "EXT_meshopt_compression", "KHR_draco_mesh_compression"};
    if (value.is_object()) {
        value.erase("extras");
        const Json all = value.contains("extensions") ? std::move(value["extensions"]) : Json();
        value.erase("extensions");
        for (const char* key : k_kept)
            if (all.is_object() && all.contains(key) && all[key].is_object()) value["extensions"][key] = all[key];
    }
    if (value.is_structured())
        for (Json& child : value) drop_extras(child);
}

/// Returns the names of a mesh's morph targets. By convention they are in its extras or in those of its first
/// primitive.
Json target_names(const Json& mesh) {
    Json names = Json::array();
    const auto collect = [&](const Json& owner) {
        if (!owner.is_object() || !names.empty()) return;
        const auto extras = owner.find("extras");
        if (extras == owner.end() || !extras->is_object()) return;
        const auto listed = extras->find("targetNames");
        if (listed == extras->end() || !listed->is_array()) return;
        for (const Json& name : *listed) names.push_back(name.is_string() ? name : Json(""));
    };
    collect(mesh);
    if (!mesh.is_object()) return names;
    const auto primitives = mesh.find("primitives");
    if (primitives != mesh.end() && primitives->is_array() && !primitives->empty()) collect(primitives->front());
    return names;
}

/// Keeps only the names of materials, which are part names.
Json named_materials(const Json& materials) {
    Json kept = Json::array();
    for (const Json& material : materials) {
        const bool is_named = material.is_object() && material.contains("name") && material["name"].is_string();
        kept.push_back(is_named ? Json{{"name", material["name"]}} : Json::object());
    }
    return kept;
}

/// Keeps only what the surface and part names need and, if wanted, animations.
Json cut_down(const Json& document, GltfContent wanted) {
    Json kept = Json::object();
    for (const char* key : {"asset", "scene", "scenes", "nodes", "meshes", "skins", "accessors", "bufferViews"})
        if (const auto it = document.find(key); it != document.end()) kept[key] = *it;
    if (const auto it = document.find("animations"); it != document.end() && wanted == GltfContent::animation)
        kept["animations"] = *it;
    if (const auto it = document.find("materials"); it != document.end() && it->is_array())
        kept["materials"] = named_materials(*it);
    drop_extras(kept);
    const auto meshes = document.find("meshes");
    if (wanted != GltfContent::animation || meshes == document.end() || !meshes->is_array()) return kept;
    for (std::size_t i = 0; i < meshes->size(); ++i)
        if (Json names = target_names((*meshes)[i]); !names.empty() && kept["meshes"][i].is_object())
            kept["meshes"][i]["extras"]["targetNames"] = std::move(names);
    return kept;
}

/// Throws unless the file is of version 2; version 1 had objects in place of lists.
void check_version(const Json& document, const std::string& name) {
    const Json::json_pointer place("/asset/version");
    const std::string version =
        document.contains(place) && document[place].is_string() ? document[place].get<std::string>() : std::string();
    const bool of_objects = std::ranges::any_of(std::array{"meshes", "nodes", "accessors"}, [&](const char* key) {
        return document.contains(key) && document[key].is_object();
    });
    if (of_objects || (!version.empty() && !version.starts_with("2.")))
        fail(name, fmt::format("glTF of version {} is not supported, only 2.0; export it again as glTF 2.0",
                               quote(version.empty() ? "1.0" : version)));
    if (version.empty()) fail(name, "this JSON is no glTF 2.0: it has no version (asset.version)");
}

/// Throws if the file needs an extension that may change its geometry and is not read. Those of appearance do not
/// matter.
void check_extensions(const Json& document, const std::string& name) {
    constexpr std::array k_read{"KHR_mesh_quantization", "EXT_mesh_gpu_instancing", "EXT_meshopt_compression",
                                "KHR_draco_mesh_compression"};
    constexpr std::array k_appearance{"material", "texture", "light", "image", "xmp", "metadata", "feature"};
    const auto required = document.find("extensionsRequired");
    if (required == document.end() || !required->is_array()) return;
    for (const Json& extension : *required) {
        const std::string word = extension.is_string() ? extension.get<std::string>() : std::string();
        const auto is_part = [&](const char* part) { return word.find(part) != std::string::npos; };
        if (std::ranges::find(k_read, word) == k_read.end() && std::ranges::none_of(k_appearance, is_part))
            fail(name, fmt::format("the file needs the extension {}, which is not supported; export it without",
                                   quote(word)));
    }
}

/// Returns the first line of the library's error message.
std::string first_line(const std::string& text) {
    const std::string_view line = trimmed(std::string_view(text).substr(0, text.find('\n')));
    return line.empty() ? "no reason is known" : printable(line, 200);
}

/// The JSON of a file, and its binary chunk.
struct OpenedGltf {
    Json document;
    std::string_view binary;
};

OpenedGltf open_gltf(std::string_view content, const std::string& name) {
    if (content.size() > k_max_gltf_bytes) fail(name, "the file is larger than 2 GiB; split it");
    GltfChunks chunks;
    if (content.starts_with("glTF"))
        chunks = binary_chunks(content, name);
    else
        chunks.json = content;
    OpenedGltf opened{parse_document(chunks.json, name), chunks.binary};
    check_version(opened.document, name);
    check_extensions(opened.document, name);
    return opened;
}

/// Has tinygltf read the JSON, which names no files.
tinygltf::Model parse_model(const Json& document, const std::string& name) {
    const std::string json = json_text(document);
    tinygltf::TinyGLTF loader;
    tinygltf::Model model;
    std::string error, warning;
    bool loaded = false;
    try {
        loaded = loader.LoadASCIIFromString(&model, &error, &warning, json.data(), static_cast<unsigned>(json.size()),
                                            std::string());
    } catch (const std::exception& exception) {
        error = exception.what();
    }
    if (!loaded) fail(name, fmt::format("the JSON is no valid glTF ({}); export it again", first_line(error)));
    return model;
}

}  // namespace

tinygltf::Model load_gltf(std::string_view content, const std::string& name, const fs::path& folder,
                          GltfContent wanted) {
    const OpenedGltf opened = open_gltf(content, name);
    GltfBuffers buffers = read_gltf_buffers(opened.document, opened.binary, name, folder);
    Json plain = cut_down(opened.document, wanted);
    expand_compressed(plain, buffers, name);
    tinygltf::Model model = parse_model(plain, name);
    model.buffers.resize(buffers.size());
    for (std::size_t i = 0; i < buffers.size(); ++i) model.buffers[i].data = std::move(buffers[i]);
    return model;
}

GltfDocument read_gltf_document(std::string_view content, const std::string& name, const fs::path& folder) {
    OpenedGltf opened = open_gltf(content, name);
    GltfBuffers buffers = read_gltf_buffers(opened.document, opened.binary, name, folder);
    expand_compressed(opened.document, buffers, name);
    return {std::move(opened.document), std::move(buffers)};
}

std::uint64_t gltf_external_buffer_bytes(std::string_view json, const std::string& name) {
    return external_bytes_of(parse_document(json, name));
}

std::string binary_gltf(std::string json, std::string_view binary) {
    constexpr std::size_t k_header_bytes = 12, k_chunk_header_bytes = 8;
    json.resize((json.size() + 3) / 4 * 4, ' ');  // chunks are aligned to four bytes
    const std::size_t binary_bytes = std::max<std::size_t>((binary.size() + 3) / 4 * 4, 4);
    std::string bytes = "glTF";
    const auto append_word = [&](std::size_t value) { append_bytes(bytes, static_cast<std::uint32_t>(value)); };
    append_word(2);
    append_word(k_header_bytes + 2 * k_chunk_header_bytes + json.size() + binary_bytes);
    append_word(json.size());
    bytes += "JSON" + json;
    append_word(binary_bytes);
    bytes.append("BIN\0", 4).append(binary);
    bytes.resize(bytes.size() + binary_bytes - binary.size(), '\0');
    return bytes;
}

}  // namespace exemplar::mesh_io
