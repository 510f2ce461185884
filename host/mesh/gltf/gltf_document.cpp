#include "host/mesh/gltf/gltf_document.h"

#include <fmt/format.h>

#include <limits>

#include "host/core/errors.h"
#include "host/core/json_text.h"
#include "host/core/text.h"
#include "host/mesh/gltf/gltf_file.h"
#include "host/mesh/io/io_text.h"

namespace exemplar::mesh_io {
namespace {

using Json = nlohmann::json;

/// Appends bytes at a multiple of eight, as the largest component of an accessor or matrix asks.
std::size_t append_aligned(std::string& binary, std::string_view bytes) {
    constexpr std::size_t k_alignment = 8;
    binary.resize((binary.size() + k_alignment - 1) / k_alignment * k_alignment, '\0');
    const std::size_t begin = binary.size();
    binary.append(bytes);
    return begin;
}

/// Points the document's views at one buffer that holds all others.
std::string joined_buffers(GltfDocument& document, const std::string& name) {
    std::string binary;
    std::vector<std::size_t> begin;
    begin.reserve(document.buffers.size());
    for (const auto& bytes : document.buffers)
        begin.push_back(append_aligned(binary, {reinterpret_cast<const char*>(bytes.data()), bytes.size()}));
    if (!document.json.contains("bufferViews")) return binary;
    for (Json& view : document.json["bufferViews"]) {
        const auto buffer = view.at("buffer").get<std::uint64_t>();
        if (buffer >= begin.size())
            fail(name, fmt::format("a buffer view names buffer {} of {}", buffer, begin.size()));
        view["buffer"] = 0;
        view["byteOffset"] = view.value("byteOffset", std::uint64_t{0}) + begin[buffer];
    }
    return binary;
}

/// Appends a view of `bytes`; returns its number.
std::size_t append_view(Json& document, std::string& binary, std::string_view bytes) {
    const std::size_t begin = append_aligned(binary, bytes);
    Json& views = document["bufferViews"];
    if (!views.is_array()) views = Json::array();
    views.push_back({{"buffer", 0}, {"byteOffset", begin}, {"byteLength", bytes.size()}});
    return views.size() - 1;
}

/// Puts the files of images into the buffer.
void embed_images(Json& document, std::string& binary, const std::string& name, const std::filesystem::path& folder,
                  std::vector<std::string>& warnings) {
    if (!document.contains("images")) return;
    for (Json& image : document["images"]) {
        const auto uri = image.find("uri");
        if (uri == image.end() || !uri->is_string()) continue;
        const std::string address = uri->get<std::string>();
        if (address.starts_with("data:")) continue;
        try {
            const std::vector<unsigned char> bytes = read_gltf_resource(address, name, folder);
            const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
            image["bufferView"] = append_view(document, binary, text);
            if (!image.contains("mimeType"))
                image["mimeType"] = text.starts_with("\x89PNG") ? "image/png" : "image/jpeg";
            image.erase("uri");
        } catch (const MeshError& error) {
            warnings.push_back(fmt::format("an image stays outside of the file: {}", error.what()));
        }
    }
}

/// Removes the extensions of compressed geometry from the list of those that readers need or may use.
void drop_expanded_extensions(Json& document) {
    for (const char* key : {"extensionsUsed", "extensionsRequired"}) {
        if (!document.contains(key) || !document[key].is_array()) continue;
        Json kept = Json::array();
        for (const Json& word : document[key])
            if (word != "EXT_meshopt_compression" && word != "KHR_draco_mesh_compression") kept.push_back(word);
        if (kept.empty())
            document.erase(key);
        else
            document[key] = kept;
    }
}

}  // namespace

std::string binary_of_document(GltfDocument document, std::span<const std::string> appended, const std::string& name,
                               const std::filesystem::path& folder, std::vector<std::string>& warnings) {
    Json& json = document.json;
    std::string binary = joined_buffers(document, name);
    for (const std::string& bytes : appended) append_view(json, binary, bytes);
    embed_images(json, binary, name, folder, warnings);
    drop_expanded_extensions(json);
    json["buffers"] = Json::array({{{"byteLength", binary.size()}}});
    if (binary.empty()) json.erase("buffers");
    if (json.contains("bufferViews") && json["bufferViews"].empty()) json.erase("bufferViews");
    std::string text = json_text(json);
    constexpr std::size_t k_room_of_headers = 64;
    if (text.size() + binary.size() + k_room_of_headers > std::numeric_limits<std::uint32_t>::max())
        fail(name, "its parts would take a file larger than 4 GiB; split it");
    return binary_gltf(std::move(text), binary);
}

}  // namespace exemplar::mesh_io
