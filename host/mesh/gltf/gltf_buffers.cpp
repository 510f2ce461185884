#include "host/mesh/gltf/gltf_buffers.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>

#include "host/mesh/io/io_text.h"

namespace exemplar::mesh_io {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using BufferBytes = std::vector<unsigned char>;

/// Decodes %XX; returns nothing if a % is not followed by two digits. A + is a plus (RFC 3986), not a space.
std::optional<std::string> percent_decoded(std::string_view text) {
    std::string decoded;
    decoded.reserve(text.size());
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] != '%') {
            decoded += text[i];
            continue;
        }
        unsigned char value = 0;
        const char *digits = text.data() + i + 1, *end = digits + 2;
        if (text.size() < i + 3 || std::from_chars(digits, end, value, 16).ptr != end) return {};
        decoded += static_cast<char>(value);
        i += 2;
    }
    return decoded;
}

/// Returns the value of each character of base64 (RFC 4648, section 4); 255 for others.
constexpr std::array<std::uint8_t, 256> base64_values() {
    constexpr std::string_view k_alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::array<std::uint8_t, 256> values{};
    values.fill(255);
    for (std::size_t i = 0; i < k_alphabet.size(); ++i)
        values[static_cast<unsigned char>(k_alphabet[i])] = static_cast<std::uint8_t>(i);
    return values;
}

/// Decodes base64, with or without = at its end; returns nothing if another character occurs.
std::optional<BufferBytes> base64_decoded(std::string_view text) {
    static constexpr std::array<std::uint8_t, 256> k_values = base64_values();
    while (text.ends_with('=')) text.remove_suffix(1);
    BufferBytes bytes;
    bytes.reserve(text.size() / 4 * 3 + 3);
    std::uint32_t bits = 0;
    int held = 0;
    for (const char c : text) {
        const std::uint8_t value = k_values[static_cast<unsigned char>(c)];
        if (value == 255) return {};
        bits = bits << 6 | value;
        held += 6;
        if (held < 8) continue;
        held -= 8;
        bytes.push_back(static_cast<unsigned char>(bits >> held));
    }
    return bytes;
}

/// Decodes data:[<media type>][;base64],<data> (RFC 2397); returns nothing if it is malformed.
std::optional<BufferBytes> data_uri_bytes(std::string_view uri) {
    const std::size_t comma = uri.find(',');
    if (comma == std::string_view::npos) return {};
    const bool escaped = uri.find('%', comma) != std::string_view::npos;
    const std::optional<std::string> decoded = escaped ? percent_decoded(uri.substr(comma + 1)) : std::nullopt;
    if (escaped && !decoded) return {};
    const std::string_view data = decoded ? std::string_view(*decoded) : uri.substr(comma + 1);
    if (uri.substr(0, comma).ends_with(";base64")) return base64_decoded(data);
    return BufferBytes(data.begin(), data.end());
}

bool is_data_uri(std::string_view uri) {
    return uri.starts_with("data:");
}

/// Returns whether an address begins with a scheme such as https: (RFC 3986, section 3.1).
bool has_scheme(std::string_view uri) {
    const std::size_t colon = uri.find(':');
    if (colon == std::string_view::npos || colon == 0 || !std::isalpha(static_cast<unsigned char>(uri[0])))
        return false;
    return std::ranges::all_of(uri.substr(0, colon),
                               [](unsigned char c) { return std::isalnum(c) || c == '+' || c == '-' || c == '.'; });
}

/// Returns the file that an address names relative to the glTF file; an empty string if that is outside its folder.
std::string file_of_uri(std::string_view uri) {
    const std::optional<std::string> decoded = percent_decoded(uri);
    if (!decoded || decoded->find('\0') != std::string::npos) return {};
    const fs::path path = fs::path(*decoded).lexically_normal();
    const bool inside = path.is_relative() && !path.empty() && *path.begin() != "..";
    return inside ? path.string() : std::string();
}

/// Returns whether the buffer only holds what EXT_meshopt_compression replaces.
bool is_fallback(const Json& buffer) {
    const Json::json_pointer flag("/extensions/EXT_meshopt_compression/fallback");
    return buffer.contains(flag) && buffer[flag] == true;
}

/// Reads the buffers of a file one after the other.
class BufferReader {
  public:
    BufferReader(std::string_view binary, const std::string& name, const fs::path& folder)
        : binary_(binary), name_(name), folder_(folder.empty() ? fs::path(".") : folder) {}

    BufferBytes read(std::size_t index, const Json& buffer) {
        what_ = fmt::format("buffer {}", index);
        const bool has_uri = buffer.is_object() && buffer.contains("uri") && buffer["uri"].is_string();
        if (!has_uri && is_fallback(buffer)) return {};
        if (!has_uri && (index > 0 || binary_.empty())) fail("has no bytes: neither uri nor binary chunk");
        const std::uint64_t bytes = declared_bytes(buffer);
        if (!has_uri) return first_bytes({binary_.begin(), binary_.end()}, bytes);
        const std::string& uri = buffer["uri"].get_ref<const std::string&>();
        if (!is_data_uri(uri)) return read_file(uri, bytes);
        std::optional<BufferBytes> content = data_uri_bytes(uri);
        if (!content) fail("has a data URI that cannot be decoded; export the file again");
        return first_bytes(std::move(*content), bytes);
    }

    /// Reads a whole file that is no buffer.
    BufferBytes read_whole(std::string_view uri) {
        what_ = fmt::format("the file {}", quote(uri));
        const std::string place = has_scheme(uri) ? std::string() : file_of_uri(uri);
        if (place.empty()) fail("is not in the folder of this one");
        std::error_code error;
        const std::uint64_t bytes = fs::file_size(inside(place), error);
        if (error) fail("cannot be read: " + error.message());
        if (bytes > k_max_gltf_bytes) fail("is larger than 2 GiB");
        return read_file(std::string(uri), bytes);
    }

  private:
    [[noreturn]] void fail(const std::string& message) const { mesh_io::fail(name_, what_ + " " + message); }

    std::uint64_t declared_bytes(const Json& buffer) {
        const auto declared = buffer.is_object() ? buffer.find("byteLength") : buffer.end();
        if (declared == buffer.end() || !declared->is_number_unsigned() || *declared == 0) fail("has no byteLength");
        const auto bytes = declared->get<std::uint64_t>();
        if (bytes > k_max_gltf_bytes - all_bytes_) mesh_io::fail(name_, "its buffers are larger than 2 GiB; split it");
        all_bytes_ += bytes;
        return bytes;
    }

    BufferBytes first_bytes(BufferBytes content, std::uint64_t bytes) const {
        check_size(content.size(), bytes);
        content.resize(bytes);
        return content;
    }
    void check_size(std::uint64_t found, std::uint64_t declared) const {
        if (found < declared) fail(fmt::format("has {} bytes instead of {}; copy or export it again", found, declared));
    }

    BufferBytes read_file(const std::string& uri, std::uint64_t bytes) {
        constexpr std::size_t k_drive = 1;  // C: is no scheme
        const std::string place = has_scheme(uri) ? std::string() : file_of_uri(uri);
        if (place.empty() && has_scheme(uri) && uri.find(':') > k_drive && !uri.starts_with("file:"))
            fail(fmt::format("is an address on the net, {}; download it beside this file and put its name there",
                             quote(uri)));
        if (place.empty()) fail("is no file in the folder of this one: " + quote(uri));
        what_ += fmt::format(", {},", quote(place));
        const fs::path path = inside(place);
        std::error_code error;
        const std::uint64_t found = fs::file_size(path, error);
        if (error) fail("cannot be read: " + error.message());
        check_size(found, bytes);
        BufferBytes content(bytes);
        std::ifstream file(path, std::ios::binary);
        file.read(reinterpret_cast<char*>(content.data()), static_cast<std::streamsize>(bytes));
        if (!file) fail("cannot be read");
        return content;
    }

    /// Returns the path with links resolved; throws if it is outside of the folder.
    fs::path inside(const std::string& place) const {
        std::error_code error;
        const fs::path root = fs::canonical(folder_, error);
        fs::path path = error ? fs::path() : fs::canonical(folder_ / place, error);
        if (error) fail("cannot be read: " + error.message());
        if (*path.lexically_relative(root).begin() == "..")
            fail("is a link that leads out of the folder of this file; put a copy in its place");
        if (!fs::is_regular_file(path, error)) fail("is no file");
        return path;
    }

    std::string_view binary_;
    const std::string& name_;
    fs::path folder_;
    std::string what_;  ///< the buffer at hand, for messages
    std::uint64_t all_bytes_ = 0;
};

}  // namespace

const std::uint64_t k_max_gltf_bytes = std::numeric_limits<std::uint32_t>::max() / 2;

GltfBuffers read_gltf_buffers(const Json& document, std::string_view binary, const std::string& name,
                              const fs::path& folder) {
    GltfBuffers read;
    const auto buffers = document.find("buffers");
    if (buffers == document.end() || !buffers->is_array()) return read;
    BufferReader reader(binary, name, folder);
    for (std::size_t i = 0; i < buffers->size(); ++i) read.push_back(reader.read(i, (*buffers)[i]));
    return read;
}

std::vector<unsigned char> read_gltf_resource(std::string_view uri, const std::string& name, const fs::path& folder) {
    return BufferReader({}, name, folder).read_whole(uri);
}

std::uint64_t external_bytes_of(const Json& document) {
    const auto buffers = document.find("buffers");
    if (buffers == document.end() || !buffers->is_array()) return 0;
    std::uint64_t bytes = 0;
    for (const Json& buffer : *buffers) {
        if (!buffer.is_object() || !buffer.contains("uri") || !buffer.contains("byteLength")) continue;
        const Json &uri = buffer["uri"], &length = buffer["byteLength"];
        if (!uri.is_string() || is_data_uri(uri.get_ref<const std::string&>())) continue;
        if (length.is_number_unsigned()) bytes += std::min(length.get<std::uint64_t>(), k_max_gltf_bytes);
    }
    return std::min(bytes, k_max_gltf_bytes);  // more is not read
}

}  // namespace exemplar::mesh_io
