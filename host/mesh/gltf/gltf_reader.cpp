#include "host/mesh/gltf/gltf_reader.h"

#include <fmt/format.h>
#include <tiny_gltf.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <type_traits>

#include "host/mesh/io/io_text.h"

namespace exemplar::mesh_io {
namespace {

/// Bounds what is read, as a file can repeat a mesh many times, and claim zeros, at a few bytes each: 64 MiB, which are
/// about 3 million triangles, and more for larger files. The result takes up to ten times as much memory.
constexpr std::uint64_t k_free_bytes = 64 << 20, k_read_bytes_per_byte = 8;
/// A small element is a number of four bytes in the result.
constexpr std::uint64_t k_min_element_bytes = 4;

int gltf_type(int components) {
    switch (components) {
        case 1:
            return TINYGLTF_TYPE_SCALAR;
        case 3:
            return TINYGLTF_TYPE_VEC3;
        case 4:
            return TINYGLTF_TYPE_VEC4;
        default:
            return TINYGLTF_TYPE_MAT4;
    }
}

/// Decodes little-endian unsigned integers of `size` bytes.
std::vector<std::uint32_t> unpacked(const std::vector<unsigned char>& bytes, std::size_t size) {
    std::vector<std::uint32_t> values(bytes.size() / size, 0);
    for (std::size_t i = 0; i < bytes.size(); ++i) values[i / size] |= std::uint32_t{bytes[i]} << (8 * (i % size));
    return values;
}

/// Decodes numbers of type T; normalized integers become fractions of the largest (glTF 2.0, section 3.6.2.2).
template <typename T>
std::vector<float> numbers_of(const std::vector<unsigned char>& bytes, bool normalized) {
    std::vector<float> values(bytes.size() / sizeof(T));
    for (std::size_t i = 0; i < values.size(); ++i) {
        T value;
        std::memcpy(&value, bytes.data() + i * sizeof(T), sizeof(T));
        values[i] = static_cast<float>(value);
        if constexpr (std::is_integral_v<T>)
            if (normalized) values[i] = std::max(values[i] / static_cast<float>(std::numeric_limits<T>::max()), -1.0f);
    }
    return values;
}

}  // namespace

GltfReader::GltfReader(const tinygltf::Model& model, const std::string& name) : model_(model), name_(name) {
    for (const tinygltf::Buffer& buffer : model.buffers) bytes_ += buffer.data.size();
    bytes_left_ = k_free_bytes + k_read_bytes_per_byte * bytes_;
}

void GltfReader::fail(const std::string& message) const {
    mesh_io::fail(name_, message);
}

void GltfReader::fail_item(const char* what, int index, std::size_t size) const {
    fail(fmt::format("{} {} is named, but there are {}", what, index, size));
}

std::vector<int> GltfReader::root_nodes() const {
    if (!model_.scenes.empty()) return item(model_.scenes, std::max(model_.defaultScene, 0), "scene").nodes;
    std::vector<bool> is_child(model_.nodes.size(), false);
    for (const tinygltf::Node& node : model_.nodes)
        for (int child : node.children)
            if (child >= 0 && static_cast<std::size_t>(child) < is_child.size())
                is_child[static_cast<std::size_t>(child)] = true;
    std::vector<int> roots;
    for (std::size_t i = 0; i < is_child.size(); ++i)
        if (!is_child[i]) roots.push_back(static_cast<int>(i));
    return roots;
}

void GltfReader::check_transform(const tinygltf::Node& node, int index) const {
    const auto check = [&](const std::vector<double>& values, std::size_t size, const char* what) {
        if (!values.empty() && values.size() != size)
            fail(fmt::format("node {} has a {} of {} numbers instead of {}", index, what, values.size(), size));
    };
    check(node.matrix, 16, "matrix");
    check(node.translation, 3, "translation");
    check(node.rotation, 4, "rotation");
    check(node.scale, 3, "scale");
}

/// Returns `count` elements of accessor `index` from a buffer view, consecutively; checks that they lie within the
/// view and its buffer.
GltfReader::Bytes GltfReader::view_elements(int index, int view_index, std::size_t offset, std::size_t count,
                                            std::size_t size) const {
    const tinygltf::BufferView& view = item(model_.bufferViews, view_index, "buffer view");
    const tinygltf::Buffer& buffer = item(model_.buffers, view.buffer, "buffer");
    const std::size_t stride = view.byteStride ? view.byteStride : size;
    const bool view_fits =
        view.byteOffset <= buffer.data.size() && view.byteLength <= buffer.data.size() - view.byteOffset;
    if (!view_fits) fail(fmt::format("buffer view {} reaches past the end of its buffer", view_index));
    const bool fits = offset <= view.byteLength && count > 0 && count - 1 <= (view.byteLength - offset) / stride &&
                      size <= view.byteLength - offset - (count - 1) * stride;
    if (!fits) fail(fmt::format("the {} elements of accessor {} are not within its buffer view", count, index));
    Bytes elements(count * size);
    const unsigned char* const first = buffer.data.data() + view.byteOffset + offset;
    for (std::size_t i = 0; i < count; ++i) std::memcpy(elements.data() + i * size, first + i * stride, size);
    return elements;
}

/// Returns the elements of an accessor, consecutively, with those that its sparse part replaces.
GltfReader::Bytes GltfReader::accessor_elements(int index, int components, std::size_t size) {
    const tinygltf::Accessor& accessor = item(model_.accessors, index, "accessor");
    if (accessor.type != gltf_type(components)) fail(fmt::format("accessor {} has the wrong type for its use", index));
    charge(index, accessor.count, size);
    Bytes elements = accessor.bufferView < 0  // then they are zeros
                         ? Bytes(accessor.count * size, 0)
                         : view_elements(index, accessor.bufferView, accessor.byteOffset, accessor.count, size);
    if (accessor.sparse.isSparse) replace_sparse(index, size, elements);
    return elements;
}

void GltfReader::charge(int index, std::size_t count, std::size_t size) {
    const std::uint64_t element = std::max<std::uint64_t>(size, k_min_element_bytes);
    if (count > bytes_left_ / element)
        fail(
            fmt::format("with the {} elements of accessor {} the scene is larger than the {} MB that are read of a "
                        "file of this size; its count is wrong, or the scene repeats its meshes: split the scene, or "
                        "remove copies",
                        count, index, (k_free_bytes + k_read_bytes_per_byte * bytes_) >> 20));
    bytes_left_ -= count * element;
}

void GltfReader::replace_sparse(int index, std::size_t size, Bytes& elements) const {
    const tinygltf::Accessor& accessor = item(model_.accessors, index, "accessor");
    const auto& [count, is_sparse, indices, values] = accessor.sparse;
    if (count < 0 || indices.byteOffset < 0 || values.byteOffset < 0)
        fail(fmt::format("the sparse part of accessor {} has a negative count or offset", index));
    if (count == 0) return;
    const auto number = static_cast<std::size_t>(count);
    const std::size_t index_size = index_bytes(indices.componentType, index);
    const std::vector<std::uint32_t> places = unpacked(
        view_elements(index, indices.bufferView, static_cast<std::size_t>(indices.byteOffset), number, index_size),
        index_size);
    const Bytes replacements =
        view_elements(index, values.bufferView, static_cast<std::size_t>(values.byteOffset), number, size);
    for (std::size_t i = 0; i < number; ++i) {
        if (places[i] >= accessor.count)
            fail(fmt::format("the sparse part of accessor {} names element {}, but there are {}", index, places[i],
                             accessor.count));
        std::memcpy(elements.data() + places[i] * size, replacements.data() + i * size, size);
    }
}

std::size_t GltfReader::index_bytes(int component_type, int index) const {
    switch (component_type) {
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return 1;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return 2;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
            return 4;
        default:
            fail(fmt::format("accessor {} holds indices that are no unsigned integers", index));
    }
}

std::vector<std::uint32_t> GltfReader::integers(int accessor, int components) {
    const std::size_t size = index_bytes(item(model_.accessors, accessor, "accessor").componentType, accessor);
    return unpacked(accessor_elements(accessor, components, size * static_cast<std::size_t>(components)), size);
}

std::vector<float> GltfReader::numbers(int accessor, int components, GltfIntegers integers) {
    const tinygltf::Accessor& source = item(model_.accessors, accessor, "accessor");
    if (source.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT && !source.normalized &&
        integers == GltfIntegers::normalized)
        fail(fmt::format("accessor {} holds numbers that are neither floats nor normalized", accessor));
    const auto read = [&]<typename T>(T) {
        return numbers_of<T>(accessor_elements(accessor, components, sizeof(T) * static_cast<std::size_t>(components)),
                             source.normalized);
    };
    switch (source.componentType) {
        case TINYGLTF_COMPONENT_TYPE_FLOAT:
            return read(float{});
        case TINYGLTF_COMPONENT_TYPE_BYTE:
            return read(std::int8_t{});
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return read(std::uint8_t{});
        case TINYGLTF_COMPONENT_TYPE_SHORT:
            return read(std::int16_t{});
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return read(std::uint16_t{});
        default:
            fail(fmt::format("accessor {} holds numbers of 32-bit integers, which glTF does not allow here", accessor));
    }
}

std::vector<Vec3> GltfReader::vectors(int accessor) {
    const std::vector<float> components = numbers(accessor, 3, GltfIntegers::any);
    std::vector<Vec3> vectors(components.size() / 3);
    for (std::size_t i = 0; i < vectors.size(); ++i) vectors[i] = Eigen::Map<const Vec3>(components.data() + 3 * i);
    return vectors;
}

bool GltfReader::has_triangles(const tinygltf::Primitive& primitive) {
    return primitive.mode >= TINYGLTF_MODE_TRIANGLES && primitive.mode <= TINYGLTF_MODE_TRIANGLE_FAN;
}

/// Strips alternate in orientation.
std::vector<Face> GltfReader::triangles(const tinygltf::Primitive& primitive, std::size_t vertex_count) {
    std::vector<std::uint32_t> corners;
    if (primitive.indices >= 0) {
        corners = integers(primitive.indices, 1);
        for (std::uint32_t corner : corners)
            if (corner >= vertex_count)
                fail(fmt::format("accessor {} names vertex {}, but there are {}", primitive.indices, corner,
                                 vertex_count));
    } else {
        for (std::size_t i = 0; i < vertex_count; ++i) corners.push_back(static_cast<std::uint32_t>(i));
    }
    const bool separate = primitive.mode == TINYGLTF_MODE_TRIANGLES,
               strip = primitive.mode == TINYGLTF_MODE_TRIANGLE_STRIP;
    if (separate && corners.size() % 3) fail(fmt::format("{} corners do not make whole triangles", corners.size()));
    std::vector<Face> faces;
    faces.reserve(separate ? corners.size() / 3 : corners.size());
    for (std::size_t i = 0; i + 2 < corners.size(); i += separate ? 3 : 1) {
        Face face{corners[i], corners[i + 1], corners[i + 2]};
        if (strip && (face[0] == face[1] || face[1] == face[2] || face[2] == face[0])) continue;
        if (strip && i % 2) std::swap(face[1], face[2]);
        if (!separate && !strip) face = {corners[i + 1], corners[i + 2], corners[0]};
        faces.push_back(face);
    }
    return faces;
}

}  // namespace exemplar::mesh_io
