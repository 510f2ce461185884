#include "host/mesh/io_gltf_scene.h"

#include <fmt/format.h>
#include <tiny_gltf.h>

#include <Eigen/Geometry>
#include <cstring>

#include "host/mesh/io_formats.h"
#include "host/mesh/io_polygons.h"
#include "host/mesh/io_text.h"
#include "host/mesh/weld.h"

namespace exemplar::mesh_io {
namespace {

using Bytes = std::vector<unsigned char>;

/// Walks the nodes of a model and collects its triangles.
class SceneReader {
  public:
    SceneReader(const tinygltf::Model& model, const std::string& name) : model_(model), name_(name) {
        for (const tinygltf::Buffer& buffer : model.buffers) bytes_ += buffer.data.size();
        corners_left_ = k_free_corners + k_corners_per_byte * bytes_;
    }

    MeshFile read() {
        if (!model_.asset.version.starts_with("2."))
            fail("glTF of version " + quote(model_.asset.version) + " is not supported, only 2");
        for (int node : root_nodes()) read_node(node, Eigen::Affine3d::Identity());
        MeshFile file;
        file.mesh = std::move(polygons_).triangulate(file.warnings);
        if (skipped_) file.warnings.push_back(fmt::format("{} primitives of points or lines were left out", skipped_));
        if (placeless_)
            file.warnings.push_back(fmt::format("{} primitives without POSITION were left out", placeless_));
        if (skinned_)
            file.warnings.push_back(
                fmt::format("the skins of {} nodes were left out; the mesh is in its rest pose", skinned_));
        if (model_.asset.generator.starts_with("Exemplar")) file.labels = labels();
        return file;
    }

  private:
    [[noreturn]] void fail(const std::string& message) const { mesh_io::fail(name_, message); }

    template <typename T>
    const T& item(const std::vector<T>& items, int index, const char* what) const {
        if (index < 0 || static_cast<std::size_t>(index) >= items.size())
            fail(fmt::format("{} {} is named, but there are {}", what, index, items.size()));
        return items[static_cast<std::size_t>(index)];
    }

    /// Of the default scene, else of the first; all nodes without a parent if there is no scene.
    std::vector<int> root_nodes() const {
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

    void read_node(int index, const Eigen::Affine3d& parent) {
        const tinygltf::Node& node = item(model_.nodes, index, "node");
        const auto number = static_cast<std::size_t>(index);
        if (visited_.size() < model_.nodes.size()) visited_.resize(model_.nodes.size(), false);
        if (visited_[number]) fail(fmt::format("node {} has two parents or is its own ancestor", index));
        visited_[number] = true;
        if (++depth_ > k_deepest) fail(fmt::format("node {} is nested too deep", index));
        const Eigen::Affine3d transform = parent * local_transform(node, index);
        if (node.mesh >= 0) {
            if (node.skin >= 0) ++skinned_;  // joints, not the node, place a skinned mesh
            read_mesh(node.mesh, node.skin >= 0 ? Eigen::Affine3d::Identity() : transform);
        }
        for (int child : node.children) read_node(child, transform);
        --depth_;
    }

    Eigen::Affine3d local_transform(const tinygltf::Node& node, int index) const {
        const auto check = [&](const std::vector<double>& values, std::size_t size, const char* what) {
            if (!values.empty() && values.size() != size)
                fail(fmt::format("node {} has a {} of {} numbers instead of {}", index, what, values.size(), size));
            return !values.empty();
        };
        Eigen::Affine3d transform = Eigen::Affine3d::Identity();
        if (check(node.matrix, 16, "matrix")) {
            transform.matrix().topRows<3>() = Eigen::Map<const Eigen::Matrix4d>(node.matrix.data()).topRows<3>();
            return transform;
        }
        if (check(node.translation, 3, "translation"))
            transform.translate(Vec3d(node.translation[0], node.translation[1], node.translation[2]));
        if (check(node.rotation, 4, "rotation"))
            transform.rotate(Eigen::Quaterniond(node.rotation[3], node.rotation[0], node.rotation[1], node.rotation[2])
                                 .normalized());
        if (check(node.scale, 3, "scale")) transform.scale(Vec3d(node.scale[0], node.scale[1], node.scale[2]));
        return transform;
    }

    void read_mesh(int index, const Eigen::Affine3d& transform) {
        for (const tinygltf::Primitive& primitive : item(model_.meshes, index, "mesh").primitives) {
            if (primitive.mode >= TINYGLTF_MODE_TRIANGLES && primitive.mode <= TINYGLTF_MODE_TRIANGLE_FAN)
                read_primitive(primitive, transform);
            else
                ++skipped_;
        }
    }

    void read_primitive(const tinygltf::Primitive& primitive, const Eigen::Affine3d& transform) {
        const auto position = primitive.attributes.find("POSITION");
        if (position == primitive.attributes.end()) {
            ++placeless_;
            return;
        }
        const std::vector<std::uint32_t> vertices = read_positions(position->second, transform);
        std::vector<std::uint32_t> corners = vertices;
        if (primitive.indices >= 0) {
            corners = read_indices(primitive.indices);
            for (std::uint32_t& corner : corners) {
                if (corner >= vertices.size())
                    fail(fmt::format("accessor {} names vertex {}, but there are {}", primitive.indices, corner,
                                     vertices.size()));
            }
        } else {
            for (std::size_t i = 0; i < corners.size(); ++i) corners[i] = static_cast<std::uint32_t>(i);
        }
        add_triangles(primitive, corners, vertices, transform.linear().determinant() < 0);
    }

    /// Strips alternate in orientation; a mirroring transform turns every triangle around.
    void add_triangles(const tinygltf::Primitive& primitive, const std::vector<std::uint32_t>& corners,
                       const std::vector<std::uint32_t>& vertices, bool mirrored) {
        const bool separate = primitive.mode == TINYGLTF_MODE_TRIANGLES,
                   strip = primitive.mode == TINYGLTF_MODE_TRIANGLE_STRIP;
        if (separate && corners.size() % 3) fail(fmt::format("{} corners do not make whole triangles", corners.size()));
        for (std::size_t i = 0; i + 2 < corners.size(); i += separate ? 3 : 1) {
            std::array<std::uint32_t, 3> face{corners[i], corners[i + 1], corners[i + 2]};
            if (strip && i % 2) std::swap(face[1], face[2]);
            if (strip && (face[0] == face[1] || face[1] == face[2] || face[2] == face[0]))
                continue;  // joins two strips
            if (!separate && !strip) face = {corners[i + 1], corners[i + 2], corners[0]};
            if (mirrored) std::swap(face[1], face[2]);
            for (std::uint32_t& corner : face) corner = vertices[corner];
            polygons_.add(face);
            materials_.push_back(primitive.material);
        }
    }

    /// `count` elements of accessor `index` from a buffer view, one right after the other; checked to lie within the
    /// view and its buffer.
    Bytes view_elements(int index, int view_index, std::size_t offset, std::size_t count, std::size_t size) const {
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

    /// The elements of an accessor, one right after the other, with those that its sparse part replaces.
    Bytes accessor_elements(int index, int type, std::size_t size) {
        const tinygltf::Accessor& accessor = item(model_.accessors, index, "accessor");
        if (accessor.type != type) fail(fmt::format("accessor {} has the wrong type for positions or indices", index));
        if (accessor.count > corners_left_)
            fail(
                fmt::format("the {} elements of accessor {} are far more than the file holds; its count is wrong, or "
                            "the scene repeats its meshes: merge or remove copies",
                            accessor.count, index));
        corners_left_ -= accessor.count;
        Bytes elements;
        if (accessor.bufferView >= 0)
            elements = view_elements(index, accessor.bufferView, accessor.byteOffset, accessor.count, size);
        else if (accessor.sparse.isSparse && accessor.count <= bytes_)
            elements.resize(accessor.count * size, 0);
        else
            fail(fmt::format("accessor {} has neither a buffer view nor sparse values for its elements", index));
        if (accessor.sparse.isSparse) replace_sparse(accessor, index, size, elements);
        return elements;
    }

    void replace_sparse(const tinygltf::Accessor& accessor, int index, std::size_t size, Bytes& elements) {
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

    /// Vertices of the mesh, one per element of the accessor.
    std::vector<std::uint32_t> read_positions(int index, const Eigen::Affine3d& transform) {
        const tinygltf::Accessor& accessor = item(model_.accessors, index, "accessor");
        if (accessor.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT)
            fail(fmt::format("accessor {} holds positions that are no floats, which is not supported", index));
        const Bytes elements = accessor_elements(index, TINYGLTF_TYPE_VEC3, sizeof(Vec3));
        const bool moves = !transform.matrix().isIdentity(0);
        std::vector<std::uint32_t> vertices;
        vertices.reserve(accessor.count);
        for (std::size_t i = 0; i < accessor.count; ++i) {
            std::array<float, 3> p;
            std::memcpy(p.data(), elements.data() + i * sizeof(p), sizeof(p));
            Vec3 position(p[0], p[1], p[2]);
            if (moves) position = (transform * position.cast<double>()).cast<float>();
            vertices.push_back(welder_.add(position, polygons_.vertices));
        }
        return vertices;
    }

    std::vector<std::uint32_t> read_indices(int index) {
        const std::size_t size = index_bytes(item(model_.accessors, index, "accessor").componentType, index);
        return unpacked(accessor_elements(index, TINYGLTF_TYPE_SCALAR, size), size);
    }
    std::size_t index_bytes(int component_type, int index) const {
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
    /// Little-endian unsigned integers of `size` bytes.
    static std::vector<std::uint32_t> unpacked(const Bytes& bytes, std::size_t size) {
        std::vector<std::uint32_t> values(bytes.size() / size, 0);
        for (std::size_t i = 0; i < bytes.size(); ++i) values[i / size] |= std::uint32_t{bytes[i]} << (8 * (i % size));
        return values;
    }

    /// A label per named material, in the order of the materials.
    FaceLabels labels() const {
        FaceLabels labels;
        std::vector<std::int32_t> label_of_material;
        for (const tinygltf::Material& material : model_.materials) {
            if (!material.name.empty() && !is_label_name(material.name))
                fail("no label can have the name " + quote(material.name) + "; rename that material");
            label_of_material.push_back(material.name.empty() ? -1 : static_cast<std::int32_t>(labels.names.size()));
            if (!material.name.empty()) labels.names.push_back(material.name);
        }
        for (int material : materials_) {
            const bool exists = material >= 0 && static_cast<std::size_t>(material) < label_of_material.size();
            labels.label.push_back(exists ? label_of_material[static_cast<std::size_t>(material)] : -1);
        }
        return labels;
    }

    /// Copies of a mesh cost a file a few bytes each; this bounds what they may grow to.
    static constexpr std::uint64_t k_free_corners = 300'000, k_corners_per_byte = 8;
    static constexpr int k_deepest = 256;

    const tinygltf::Model& model_;
    const std::string& name_;
    PolygonList polygons_;
    VertexWelder welder_;
    std::vector<int> materials_;  ///< per polygon; -1 for none
    std::vector<bool> visited_;
    std::uint64_t bytes_ = 0, corners_left_ = 0;
    std::size_t skipped_ = 0, placeless_ = 0, skinned_ = 0;
    int depth_ = 0;
};

}  // namespace

MeshFile mesh_of_gltf(const tinygltf::Model& model, const std::string& name) {
    return SceneReader(model, name).read();
}

}  // namespace exemplar::mesh_io
