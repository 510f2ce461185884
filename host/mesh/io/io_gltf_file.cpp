#include "host/mesh/io/io_gltf_file.h"

#include <fmt/format.h>
#include <tiny_gltf.h>

#include <algorithm>
#include <charconv>
#include <cstring>
#include <fstream>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>
#include <vector>

#include "host/core/json_text.h"
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

void drop_extras(Json& value) {
    if (value.is_object()) {
        value.erase("extras");
        value.erase("extensions");
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

/// Keeps only what geometry and part names need and, if wanted, skins, morph targets and animations.
Json cut_down(const Json& document, GltfContent wanted) {
    Json kept = Json::object();
    for (const char* key : {"asset", "scene", "scenes", "nodes", "meshes", "accessors", "bufferViews", "buffers"})
        if (const auto it = document.find(key); it != document.end()) kept[key] = *it;
    if (wanted == GltfContent::animation)
        for (const char* key : {"skins", "animations"})
            if (const auto it = document.find(key); it != document.end()) kept[key] = *it;
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

/// Throws if the file needs compressed, quantized or instanced geometry, which cannot be read. Extensions of
/// appearance do not matter.
void check_extensions(const Json& document, const std::string& name) {
    const auto required = document.find("extensionsRequired");
    if (required == document.end() || !required->is_array()) return;
    for (const Json& extension : *required) {
        const std::string word = extension.is_string() ? extension.get<std::string>() : std::string();
        for (const char* part : {"compression", "quantization", "instancing"})
            if (word.find(part) != std::string::npos)
                fail(name, fmt::format("the file needs the extension {}, which is not supported; export it without",
                                       quote(word)));
    }
}

/// Returns the file that an address names relative to the glTF file, decoded as the library decodes it (%20 and +)
/// and normalized, so that equal files give equal text. Returns an empty string if it lies outside the folder, or if
/// a % is not followed by two digits, which the library would decode to anything.
std::string file_of_uri(const std::string& uri) {
    std::string decoded;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        if (uri[i] != '%') {
            decoded += uri[i] == '+' ? ' ' : uri[i];
            continue;
        }
        unsigned char value = 0;
        const char *digits = uri.data() + i + 1, *end = digits + 2;
        if (uri.size() < i + 3 || std::from_chars(digits, end, value, 16).ptr != end || value == 0) return {};
        decoded += static_cast<char>(value);
        i += 2;
    }
    const fs::path path = fs::path(decoded).lexically_normal();
    const bool inside = path.is_relative() && !path.empty() && *path.begin() != "..";
    return inside ? path.string() : std::string();
}

std::string normal_path(const std::string& path) {
    return fs::path(path).lexically_normal().string();
}

/// The content of external buffers by the path that the library asks for. It opens no file itself.
using BufferFiles = std::map<std::string, std::vector<unsigned char>>;

/// Maximum size of external buffers, and of the glTF file itself.
constexpr std::uint64_t k_max_bytes = std::numeric_limits<std::uint32_t>::max() / 2;

fs::path folder_of_buffers(const fs::path& folder) {
    return folder.empty() ? fs::path(".") : folder;
}

/// Reads external buffers, only from the folder of the glTF file (refusing links that lead out of it) and only as
/// many bytes as the JSON declares.
class BufferReader {
  public:
    BufferReader(const fs::path& folder, const std::string& name) : folder_(folder_of_buffers(folder)), name_(name) {}

    /// `place` is the result of file_of_uri for buffer `index`.
    void read(std::size_t index, const std::string& place, const Json& buffer) {
        const std::string what = fmt::format("buffer {}, {},", index, quote(place));
        const fs::path path = inside(place, what);
        const std::uint64_t bytes = checked_size(path, buffer, what);
        if (!seen_.insert(path).second) fail(name_, fmt::format("{} is the same file as another; merge the two", what));
        std::vector<unsigned char> content(bytes);
        std::ifstream file(path, std::ios::binary);
        file.read(reinterpret_cast<char*>(content.data()), static_cast<std::streamsize>(bytes));
        if (!file) fail(name_, what + " cannot be read");
        files_[normal_path((folder_ / place).string())] = std::move(content);
    }
    BufferFiles take() { return std::move(files_); }

  private:
    /// Returns the path with links resolved; throws if it is outside of the folder.
    fs::path inside(const std::string& place, const std::string& what) const {
        std::error_code error;
        const fs::path root = fs::canonical(folder_, error);
        fs::path path = error ? fs::path() : fs::canonical(folder_ / place, error);
        if (error) fail(name_, fmt::format("{} cannot be read: {}", what, error.message()));
        if (*path.lexically_relative(root).begin() == "..")
            fail(name_, what + " is a link that leads out of the folder of this file; put a copy in its place");
        if (!fs::is_regular_file(path, error)) fail(name_, what + " is no file");
        return path;
    }
    std::uint64_t checked_size(const fs::path& path, const Json& buffer, const std::string& what) {
        const auto declared = buffer.find("byteLength");
        if (declared == buffer.end() || !declared->is_number_unsigned()) fail(name_, what + " has no byteLength");
        std::error_code error;
        const auto bytes = declared->get<std::uint64_t>(), found = std::uint64_t{fs::file_size(path, error)};
        if (error) fail(name_, fmt::format("{} cannot be read: {}", what, error.message()));
        if (found != bytes)
            fail(name_, fmt::format("{} has {} bytes instead of {}; copy or export it again", what, found, bytes));
        if (bytes > k_max_bytes - all_bytes_) fail(name_, "its buffers are larger than 2 GiB; split it");
        all_bytes_ += bytes;
        return bytes;
    }

    fs::path folder_;
    const std::string& name_;
    BufferFiles files_;
    std::set<fs::path> seen_;
    std::uint64_t all_bytes_ = 0;
};

/// Checks that no two buffers share bytes: the first may be the binary chunk, every other has an address of its own.
/// Returns the external ones.
BufferFiles read_buffers(const Json& document, const GltfChunks& chunks, const std::string& name,
                         const fs::path& folder) {
    const auto buffers = document.find("buffers");
    if (buffers == document.end() || !buffers->is_array()) return {};
    std::set<std::string> seen;
    std::vector<std::pair<std::size_t, std::string>> in_files;
    for (std::size_t i = 0; i < buffers->size(); ++i) {
        const Json& buffer = (*buffers)[i];
        const bool has_uri = buffer.is_object() && buffer.contains("uri") && buffer["uri"].is_string();
        if (!has_uri) {
            if (i > 0 || chunks.binary.empty())
                fail(name, fmt::format("buffer {} has no bytes: neither uri nor binary chunk", i));
            continue;
        }
        const auto uri = buffer["uri"].get<std::string>();
        const bool embedded = uri.starts_with("data:");
        const std::string place = embedded ? uri : file_of_uri(uri);
        if (place.empty()) fail(name, fmt::format("buffer {} is no file in the folder of this one: {}", i, quote(uri)));
        if (!seen.insert(place).second)
            fail(name, fmt::format("buffer {} has the same uri as another; merge the two", i));
        if (!embedded) in_files.emplace_back(i, place);
    }
    BufferReader reader(folder, name);
    for (const auto& [index, place] : in_files) reader.read(index, place, (*buffers)[index]);
    return reader.take();
}

/// Returns the input for the library: .glb with the cut-down JSON if there is a binary chunk, else the JSON.
std::string rebuilt(const Json& document, const GltfChunks& chunks) {
    std::string json = json_text(document);
    return chunks.binary.empty() ? json : binary_gltf(std::move(json), chunks.binary);
}

/// Returns callbacks that give the library the files already read, and nothing else.
tinygltf::FsCallbacks callbacks_for(BufferFiles* files) {
    tinygltf::FsCallbacks callbacks{};
    callbacks.FileExists = [](const std::string& path, void* data) {
        return static_cast<BufferFiles*>(data)->contains(normal_path(path));
    };
    callbacks.ExpandFilePath = [](const std::string& path, void*) { return path; };
    callbacks.ReadWholeFile = [](std::vector<unsigned char>* out, std::string*, const std::string& path, void* data) {
        *out = std::move((*static_cast<BufferFiles*>(data))[normal_path(path)]);
        return true;
    };
    callbacks.WriteWholeFile = [](std::string*, const std::string&, const std::vector<unsigned char>&, void*) {
        return false;
    };
    callbacks.user_data = files;
    return callbacks;
}

/// Returns the first line of the library's error message.
std::string first_line(const std::string& text) {
    const std::string_view line = trimmed(std::string_view(text).substr(0, text.find('\n')));
    return line.empty() ? "tinygltf cannot read it" : printable(line, 200);
}

tinygltf::Model load_model(const std::string& bytes, const std::string& name, const fs::path& folder,
                           BufferFiles files) {
    tinygltf::TinyGLTF loader;
    tinygltf::Model model;
    std::string error, warning;
    const std::string base = folder_of_buffers(folder).string();
    loader.SetFsCallbacks(callbacks_for(&files));
    const auto size = static_cast<unsigned>(bytes.size());
    bool loaded = false;
    try {
        if (bytes.starts_with("glTF"))
            loaded = loader.LoadBinaryFromMemory(&model, &error, &warning,
                                                 reinterpret_cast<const unsigned char*>(bytes.data()), size, base);
        else
            loaded = loader.LoadASCIIFromString(&model, &error, &warning, bytes.data(), size, base);
    } catch (const std::exception& exception) {
        error = exception.what();
    }
    if (!loaded) fail(name, first_line(error));
    return model;
}

}  // namespace

tinygltf::Model load_gltf(std::string_view content, const std::string& name, const fs::path& folder,
                          GltfContent wanted) {
    if (content.size() > k_max_bytes) fail(name, "the file is larger than 2 GiB; split it");
    GltfChunks chunks;
    if (content.starts_with("glTF"))
        chunks = binary_chunks(content, name);
    else
        chunks.json = content;
    const Json document = parse_document(chunks.json, name);
    check_extensions(document, name);
    BufferFiles files = read_buffers(document, chunks, name, folder);
    return load_model(rebuilt(cut_down(document, wanted), chunks), name, folder, std::move(files));
}

std::uint64_t gltf_external_buffer_bytes(std::string_view json, const std::string& name) {
    const Json document = parse_document(json, name);
    const auto buffers = document.find("buffers");
    if (buffers == document.end() || !buffers->is_array()) return 0;
    std::uint64_t bytes = 0;
    for (const Json& buffer : *buffers) {
        if (!buffer.is_object() || !buffer.contains("uri") || !buffer.contains("byteLength")) continue;
        const Json &uri = buffer["uri"], &length = buffer["byteLength"];
        if (!uri.is_string() || uri.get_ref<const std::string&>().starts_with("data:")) continue;
        if (length.is_number_unsigned()) bytes += std::min(length.get<std::uint64_t>(), k_max_bytes);
    }
    return std::min(bytes, k_max_bytes);  // more is not read
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
