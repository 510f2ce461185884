// NumPy's .npy, format 1.0 to 3.0: a one-dimensional array of integers.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>

#include "host/mesh/io/io_text.h"
#include "host/mesh/io/io_write_text.h"
#include "host/mesh/label_files/label_formats.h"

namespace exemplar::label_files {
namespace {

constexpr std::string_view k_npy_magic("\x93NUMPY", 6);
constexpr std::size_t k_npy_version_bytes = 2;

/// The value behind 'key': in the header, up to the comma behind it, or behind the bracket if it begins with one.
std::string_view header_value(std::string_view header, std::string_view key) {
    const std::size_t at = header.find(key);
    if (at == std::string_view::npos) return {};
    std::string_view rest = header.substr(at + key.size());
    const std::size_t colon = rest.find(':');
    if (colon == std::string_view::npos) return {};
    rest = mesh_io::trimmed(rest.substr(colon + 1));
    const std::size_t end = rest.starts_with('(') ? rest.find(')') : rest.find(',');
    return mesh_io::trimmed(rest.substr(0, end));
}

/// The type of the elements: a kind (i or u) and a size in bytes.
struct IntegerType {
    char kind;
    std::size_t bytes;
};

IntegerType parse_type(std::string_view text, const std::string& name) {
    constexpr std::size_t k_quoted = 5;  // '<i4'
    const bool is_little = text.size() == k_quoted && (text[1] == '<' || text[1] == '|' || text[1] == '=');
    const IntegerType type{is_little ? text[2] : '\0', is_little ? static_cast<std::size_t>(text[3] - '0') : 0};
    const bool is_size = type.bytes == 1 || type.bytes == 2 || type.bytes == 4 || type.bytes == 8;
    if ((type.kind != 'i' && type.kind != 'u') || !is_size)
        fail(name,
             fmt::format("holds {}, not little-endian integers; save labels.astype('int32')", mesh_io::quote(text)));
    return type;
}

std::int64_t integer_at(const char* bytes, const IntegerType& type) {
    std::uint64_t value = 0;
    std::memcpy(&value, bytes, type.bytes);
    const std::size_t unused = 64 - 8 * type.bytes;
    if (type.kind == 'i') return static_cast<std::int64_t>(value << unused) >> unused;
    return static_cast<std::int64_t>(value);
}

}  // namespace

FaceLabels read_npy_labels(std::string_view content, const TriangleMesh& mesh, const std::string& name) {
    if (!content.starts_with(k_npy_magic) || content.size() < 12) fail(name, "byte 0: is no NumPy array");
    const bool is_first_version = content[k_npy_magic.size()] == 1;
    const std::size_t begin = k_npy_magic.size() + k_npy_version_bytes + (is_first_version ? 2 : 4);
    std::uint32_t header_bytes = 0;
    std::memcpy(&header_bytes, content.data() + k_npy_magic.size() + k_npy_version_bytes, is_first_version ? 2 : 4);
    if (header_bytes > content.size() - begin)
        fail(name, "byte 8: the header reaches past the end; the file is cut off");
    const std::string_view header = content.substr(begin, header_bytes), data = content.substr(begin + header_bytes);
    const IntegerType type = parse_type(header_value(header, "'descr'"), name);
    std::string_view shape = header_value(header, "'shape'");
    shape.remove_prefix(std::min<std::size_t>(shape.size(), 1));
    const auto count = mesh_io::parse_integer(mesh_io::trimmed(shape.substr(0, shape.find(','))));
    const std::size_t comma = shape.find(',');
    const bool is_flat = comma == std::string_view::npos || mesh_io::trimmed(shape.substr(comma + 1)).empty();
    if (!count || *count < 1 || !is_flat) fail(name, "is no one-dimensional array of labels; save labels.ravel()");
    if (static_cast<std::uint64_t>(*count) > data.size() / type.bytes)
        fail(name, fmt::format("has {} bytes for {} labels; it is cut off", data.size(), *count));
    std::vector<std::int64_t> numbers;
    numbers.reserve(static_cast<std::size_t>(*count));
    for (std::size_t i = 0; i < static_cast<std::size_t>(*count); ++i)
        numbers.push_back(integer_at(data.data() + i * type.bytes, type));
    return labels_of_numbers(numbers, {}, mesh, name);
}

std::string npy_of_labels(const FaceLabels& labels) {
    constexpr std::size_t k_before_text = 10, k_alignment = 64;
    std::string text = fmt::format("{{'descr': '<i4', 'fortran_order': False, 'shape': ({},), }}", labels.label.size());
    text.append(k_alignment - (k_before_text + text.size() + 1) % k_alignment, ' ');
    text.push_back('\n');
    std::string bytes(k_npy_magic);
    bytes += std::string_view("\1\0", 2);
    mesh_io::append_bytes(bytes, static_cast<std::uint16_t>(text.size()));
    bytes += text;
    for (const std::int32_t label : labels.label) mesh_io::append_bytes(bytes, label);
    return bytes;
}

}  // namespace exemplar::label_files
