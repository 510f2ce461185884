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

/// Checked access to what tinygltf made of a file: every index, count and offset is looked at before it is followed.
/// All functions throw MeshError that begins with the file's name. `model` and `name` must outlive the reader.
class GltfReader {
  public:
    GltfReader(const tinygltf::Model& model, const std::string& name);

    const tinygltf::Model& model() const { return model_; }
    /// Bytes of all buffers together.
    std::uint64_t bytes() const { return bytes_; }
    [[noreturn]] void fail(const std::string& message) const;

    /// Element `index` of one of the model's lists; `what` names the list for the error.
    template <typename T>
    const T& item(const std::vector<T>& items, int index, const char* what) const {
        if (index < 0 || static_cast<std::size_t>(index) >= items.size()) fail_item(what, index, items.size());
        return items[static_cast<std::size_t>(index)];
    }

    /// Of the default scene, else of the first; all nodes without a parent if there is no scene.
    std::vector<int> root_nodes() const;
    /// `node` has no list of numbers for its place that is of the wrong length.
    void check_transform(const tinygltf::Node& node, int index) const;

    /// Unsigned integers of `components` (1: SCALAR, 4: VEC4) each, one element after the other.
    std::vector<std::uint32_t> integers(int accessor, int components);
    /// Numbers of `components` (1: SCALAR, 3: VEC3, 4: VEC4, 16: MAT4) each: floats, or normalized integers of one or
    /// two bytes.
    std::vector<float> numbers(int accessor, int components);
    /// Positions, which must be floats.
    std::vector<Vec3> positions(int accessor);

    /// Whether the primitive holds triangles (as such, as a strip or as a fan).
    static bool has_triangles(const tinygltf::Primitive& primitive);
    /// The triangles of a primitive that has some, of `vertex_count` vertices. Those without area that join the parts
    /// of a strip are left out.
    std::vector<Face> triangles(const tinygltf::Primitive& primitive, std::size_t vertex_count);

  private:
    using Bytes = std::vector<unsigned char>;

    [[noreturn]] void fail_item(const char* what, int index, std::size_t size) const;
    Bytes view_elements(int index, int view_index, std::size_t offset, std::size_t count, std::size_t size) const;
    Bytes accessor_elements(int index, int components, std::size_t size);
    void replace_sparse(int index, std::size_t size, Bytes& elements) const;
    std::size_t index_bytes(int component_type, int index) const;

    const tinygltf::Model& model_;
    const std::string& name_;
    std::uint64_t bytes_ = 0, elements_left_ = 0;
};

}  // namespace exemplar::mesh_io
