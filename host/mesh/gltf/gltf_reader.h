#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "host/mesh/mesh.h"

namespace tinygltf {
class Model;
struct Node;
struct Primitive;
}  // namespace tinygltf

namespace exemplar::mesh_io {

/// Which integers may stand for numbers: those that an accessor calls normalized, or also plain ones.
enum class GltfIntegers { normalized, any };

/// Checked access to a model that tinygltf loaded: every index, count and offset is checked before it is used. All
/// functions throw MeshError that begins with the file's name. `model` and `name` must outlive the reader.
class GltfReader {
  public:
    GltfReader(const tinygltf::Model& model, const std::string& name);

    const tinygltf::Model& model() const { return model_; }
    /// Returns the size of all buffers together.
    std::uint64_t bytes() const { return bytes_; }
    [[noreturn]] void fail(const std::string& message) const;

    /// Returns element `index` of one of the model's lists; `what` names the list for the error.
    template <typename T>
    const T& item(const std::vector<T>& items, int index, const char* what) const {
        if (index < 0 || static_cast<std::size_t>(index) >= items.size()) fail_item(what, index, items.size());
        return items[static_cast<std::size_t>(index)];
    }

    /// Returns the roots of the default scene, else of the first; all nodes without a parent if there is no scene.
    std::vector<int> root_nodes() const;
    /// Throws if the matrix, translation, rotation or scale of `node` has the wrong number of values.
    void check_transform(const tinygltf::Node& node, int index) const;

    /// Returns the unsigned integers of an accessor, element by element; `components` is 1 (SCALAR) or 4 (VEC4).
    std::vector<std::uint32_t> integers(int accessor, int components);
    /// Returns the numbers of an accessor, element by element: floats, or integers of one or two bytes as `integers`
    /// says; `components` is 1 (SCALAR), 3 (VEC3), 4 (VEC4) or 16 (MAT4).
    std::vector<float> numbers(int accessor, int components, GltfIntegers integers = GltfIntegers::normalized);
    /// Returns the positions or offsets of an accessor of VEC3, which may be quantized (KHR_mesh_quantization).
    std::vector<Vec3> vectors(int accessor);

    /// Returns whether the primitive holds triangles (as a list, a strip or a fan).
    static bool has_triangles(const tinygltf::Primitive& primitive);
    /// Returns the triangles of a primitive that has_triangles, over `vertex_count` vertices. Leaves out those
    /// without area that join the parts of a strip.
    std::vector<Face> triangles(const tinygltf::Primitive& primitive, std::size_t vertex_count);

  private:
    using Bytes = std::vector<unsigned char>;

    [[noreturn]] void fail_item(const char* what, int index, std::size_t size) const;
    Bytes view_elements(int index, int view_index, std::size_t offset, std::size_t count, std::size_t size) const;
    Bytes accessor_elements(int index, int components, std::size_t size);
    /// Throws if `count` more elements of `size` bytes are too many.
    void charge(int index, std::size_t count, std::size_t size);
    void replace_sparse(int index, std::size_t size, Bytes& elements) const;
    std::size_t index_bytes(int component_type, int index) const;

    const tinygltf::Model& model_;
    const std::string& name_;
    std::uint64_t bytes_ = 0;       ///< size of all buffers
    std::uint64_t bytes_left_ = 0;  ///< that may still be read
};

}  // namespace exemplar::mesh_io
