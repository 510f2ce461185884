#include "host/data/safetensors.h"

#include <fmt/format.h>

#include <bit>
#include <cstring>
#include <nlohmann/json.hpp>
#include <ostream>

#include "host/core/errors.h"
#include "host/core/files.h"
#include "host/core/json_text.h"
#include "host/mesh/io/io_text.h"

namespace exemplar {
namespace {

using Json = nlohmann::json;

static_assert(std::endian::native == std::endian::little, "safetensors are little-endian");

template <typename T>
constexpr const char* k_type_name = nullptr;
template <>
constexpr const char* k_type_name<float> = "F32";
template <>
constexpr const char* k_type_name<std::uint8_t> = "U8";
template <>
constexpr const char* k_type_name<std::uint16_t> = "U16";
template <>
constexpr const char* k_type_name<Half> = "F16";
template <>
constexpr const char* k_type_name<std::uint32_t> = "U32";
template <>
constexpr const char* k_type_name<std::uint64_t> = "U64";
template <>
constexpr const char* k_type_name<std::int32_t> = "I32";
template <>
constexpr const char* k_type_name<std::int8_t> = "I8";

std::size_t element_size(const std::string& type) {
    if (type == "U8" || type == "I8") return 1;
    if (type == "F16" || type == "U16") return 2;
    if (type == "F32" || type == "U32" || type == "I32") return 4;
    if (type == "U64") return 8;
    return 0;
}

/// Computes the number of bytes of a tensor; returns false on overflow.
bool byte_count(const std::vector<std::size_t>& shape, std::size_t element, std::size_t& bytes) {
    bytes = element;
    for (const std::size_t extent : shape)
        if (__builtin_mul_overflow(bytes, extent, &bytes)) return false;
    return true;
}

[[noreturn]] void damaged(const std::string& path, const std::string& what) {
    throw ModelError(fmt::format("{}: damaged file: {}; copy or train it again", path, what));
}

/// Returns a list of sizes; throws for anything else (-1, 1e300, true), which the library would convert.
std::vector<std::size_t> sizes_of(const std::string& path, const std::string& name, const Json& values) {
    if (!values.is_array()) damaged(path, mesh_io::quote(name) + " has no list of sizes");
    std::vector<std::size_t> sizes;
    for (const Json& value : values) {
        if (!value.is_number_unsigned()) damaged(path, mesh_io::quote(name) + " has a size that is no whole number");
        sizes.push_back(value.get<std::size_t>());
    }
    return sizes;
}

/// Returns the array that a header's entry describes; its bytes refer to `data`.
Tensor parse_tensor(const std::string& path, const std::string& name, const Json& entry, std::string_view data) {
    if (!entry.is_object() || !entry.contains("dtype") || !entry.contains("shape") || !entry.contains("data_offsets"))
        damaged(path, "the entry " + mesh_io::quote(name) + " is incomplete");
    Tensor tensor;
    tensor.type = entry["dtype"].get<std::string>();
    tensor.shape = sizes_of(path, name, entry["shape"]);
    const std::vector<std::size_t> offsets = sizes_of(path, name, entry["data_offsets"]);
    const std::size_t element = element_size(tensor.type);
    if (element == 0)
        damaged(path, fmt::format("{} has the unknown type {}", mesh_io::quote(name), mesh_io::quote(tensor.type)));
    std::size_t bytes = 0;
    if (offsets.size() != 2 || offsets[0] > offsets[1] || offsets[1] > data.size() ||
        !byte_count(tensor.shape, element, bytes) || bytes != offsets[1] - offsets[0])
        damaged(path, fmt::format("{} does not fit the file", mesh_io::quote(name)));
    tensor.bytes = {reinterpret_cast<const std::uint8_t*>(data.data()) + offsets[0], bytes};
    return tensor;
}

/// Throws unless the tensors cover the data without gap or overlap: overlapping ones could describe more memory than
/// the file has, and bytes of no tensor would be lost.
void check_tiling(const std::string& path, const Json& header, std::size_t bytes) {
    std::vector<std::pair<std::size_t, std::size_t>> ranges;
    for (const auto& [name, entry] : header.items())
        if (name != "__metadata__")
            if (const auto ends = sizes_of(path, name, entry.at("data_offsets")); ends.size() == 2)
                ranges.emplace_back(ends[0], ends[1]);
    std::ranges::sort(ranges);
    std::size_t end = 0;
    for (const auto& [first, last] : ranges) {
        if (first != end) damaged(path, fmt::format("its arrays overlap or leave a gap at byte {} of the data", end));
        end = last;
    }
    if (end != bytes) damaged(path, fmt::format("it has {} bytes of data where {} are described", bytes, end));
}

TensorFile parse(const std::string& path, const FileView& read) {
    const std::string_view content = read.content;
    std::uint64_t header_size = 0;
    if (content.size() < sizeof(header_size)) damaged(path, "it is too short for a header");
    std::memcpy(&header_size, content.data(), sizeof(header_size));
    if (header_size > content.size() - sizeof(header_size)) damaged(path, "it is truncated inside the header");
    const std::string_view header = content.substr(sizeof(header_size), header_size);
    const std::string_view data = content.substr(sizeof(header_size) + header_size);

    const Json json = parse_json(header);
    if (!json.is_object()) damaged(path, "the header is no object");
    TensorFile file;
    file.path = path;
    check_tiling(path, json, data.size());
    for (const auto& [name, entry] : json.items()) {
        if (name == "__metadata__") {
            file.metadata = entry.get<std::map<std::string, std::string>>();
            continue;
        }
        Tensor& tensor = file.tensors[name] = parse_tensor(path, name, entry, data);
        tensor.owner = read.owner;
    }
    return file;
}

std::string shape_text(const std::vector<std::size_t>& shape) {
    return fmt::format("[{}]", fmt::join(shape, " x "));
}

template <typename View>
TensorFile read_with(const std::filesystem::path& path, View&& view) {
    FileView content;
    try {
        content = view(path);
    } catch (const DataError& error) {
        throw ModelError(error.what());
    }
    try {
        return parse(path.string(), content);
    } catch (const Json::exception&) {
        damaged(path.string(), "its header cannot be parsed");
    }
}

bool shape_matches(const std::vector<std::size_t>& shape, const std::vector<std::size_t>& wanted) {
    if (shape.size() != wanted.size()) return false;
    for (std::size_t i = 0; i < shape.size(); ++i)
        if (wanted[i] != TensorFile::k_any && wanted[i] != shape[i]) return false;
    return true;
}

}  // namespace

template <typename T>
void TensorFile::add(const std::string& name, std::vector<std::size_t> shape, std::span<const T> values) {
    const auto copy = std::make_shared<const std::vector<T>>(values.begin(), values.end());
    const std::span<const std::uint8_t> bytes{reinterpret_cast<const std::uint8_t*>(copy->data()), values.size_bytes()};
    tensors[name] = {k_type_name<T>, std::move(shape), bytes, copy};
}

template <typename T>
std::vector<T> TensorFile::get(const std::string& name, const std::vector<std::size_t>& shape, std::size_t room) const {
    const auto found = tensors.find(name);
    if (found == tensors.end()) damaged(path, fmt::format("the array '{}' is missing", name));
    const Tensor& tensor = found->second;
    if (tensor.type != k_type_name<T>)
        damaged(path, fmt::format("the array '{}' has type {} instead of {}", name, tensor.type, k_type_name<T>));
    if (!shape.empty() && !shape_matches(tensor.shape, shape))
        damaged(path,
                fmt::format("the array '{}' has shape {}", name, mesh_io::printable(shape_text(tensor.shape), 100)));
    const std::size_t count = tensor.bytes.size() / sizeof(T);
    std::vector<T> values;
    values.reserve(count + room);
    if (reinterpret_cast<std::uintptr_t>(tensor.bytes.data()) % alignof(T) == 0) {
        const T* first = reinterpret_cast<const T*>(tensor.bytes.data());
        values.assign(first, first + count);  // writes the memory once; resize() would first write zeros
    } else if (count > 0) {
        values.resize(count);
        std::memcpy(values.data(), tensor.bytes.data(), tensor.bytes.size());
    }
    return values;
}

const std::string& TensorFile::meta(const std::string& key) const {
    const auto found = metadata.find(key);
    if (found == metadata.end()) damaged(path, fmt::format("the metadata '{}' is missing", key));
    return found->second;
}

#define EXEMPLAR_INSTANTIATE(T)                                                                         \
    template void TensorFile::add<T>(const std::string&, std::vector<std::size_t>, std::span<const T>); \
    template std::vector<T> TensorFile::get<T>(const std::string&, const std::vector<std::size_t>&, std::size_t) const;
EXEMPLAR_INSTANTIATE(float)
EXEMPLAR_INSTANTIATE(Half)
EXEMPLAR_INSTANTIATE(std::uint8_t)
EXEMPLAR_INSTANTIATE(std::uint16_t)
EXEMPLAR_INSTANTIATE(std::uint32_t)
EXEMPLAR_INSTANTIATE(std::uint64_t)
EXEMPLAR_INSTANTIATE(std::int32_t)
EXEMPLAR_INSTANTIATE(std::int8_t)
#undef EXEMPLAR_INSTANTIATE

void write_safetensors(const std::filesystem::path& path, const TensorFile& file) {
    Json header = Json::object();
    header["__metadata__"] = file.metadata;
    std::size_t offset = 0;
    for (const auto& [name, tensor] : file.tensors) {
        header[name] = {
            {"dtype", tensor.type}, {"shape", tensor.shape}, {"data_offsets", {offset, offset + tensor.bytes.size()}}};
        offset += tensor.bytes.size();
    }
    // File names in the metadata may have any encoding; bytes that are not UTF-8, which JSON needs, become U+FFFD.
    std::string text = json_text(header);
    text.resize((text.size() + 7) / 8 * 8, ' ');  // keeps the arrays aligned for readers that map the file
    const std::uint64_t size = text.size();
    write_file_atomically(path, [&](std::ostream& out) {
        out.write(reinterpret_cast<const char*>(&size), sizeof(size));
        out.write(text.data(), static_cast<std::streamsize>(text.size()));
        for (const auto& [name, tensor] : file.tensors)
            out.write(reinterpret_cast<const char*>(tensor.bytes.data()),
                      static_cast<std::streamsize>(tensor.bytes.size()));
    });
}

TensorFile read_safetensors(const std::filesystem::path& path) {
    return read_with(path, hold_file);
}

TensorFile map_safetensors(const std::filesystem::path& path) {
    return read_with(path, view_file);
}

}  // namespace exemplar
