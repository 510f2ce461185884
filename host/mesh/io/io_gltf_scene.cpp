// Reads the triangles of a glTF scene.
#include <fmt/format.h>
#include <tiny_gltf.h>

#include <Eigen/Geometry>

#include "host/mesh/editing/weld.h"
#include "host/mesh/io/io_formats.h"
#include "host/mesh/io/io_gltf_file.h"
#include "host/mesh/io/io_gltf_reader.h"
#include "host/mesh/io/io_polygons.h"
#include "host/mesh/io/io_text.h"

namespace exemplar::mesh_io {
namespace {

/// Walks the nodes of a model and collects its triangles.
class SceneReader {
  public:
    SceneReader(const tinygltf::Model& model, const std::string& name)
        : model_(model), gltf_(model, name), visited_(model.nodes.size(), false) {}

    MeshFile read() {
        for (int node : gltf_.root_nodes()) read_node(node, Eigen::Affine3d::Identity());
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
    void read_node(int index, const Eigen::Affine3d& parent) {
        const tinygltf::Node& node = gltf_.item(model_.nodes, index, "node");
        const auto number = static_cast<std::size_t>(index);
        if (visited_[number]) gltf_.fail(fmt::format("node {} has two parents or is its own ancestor", index));
        visited_[number] = true;
        if (++depth_ > k_deepest) gltf_.fail(fmt::format("node {} is nested too deep", index));
        const Eigen::Affine3d transform = parent * local_transform(node, index);
        if (node.mesh >= 0) {
            if (node.skin >= 0) ++skinned_;  // a skinned mesh is placed by its joints, not by the node
            read_mesh(node.mesh, node.skin >= 0 ? Eigen::Affine3d::Identity() : transform);
        }
        for (int child : node.children) read_node(child, transform);
        --depth_;
    }

    Eigen::Affine3d local_transform(const tinygltf::Node& node, int index) const {
        gltf_.check_transform(node, index);
        Eigen::Affine3d transform = Eigen::Affine3d::Identity();
        if (!node.matrix.empty()) {
            transform.matrix().topRows<3>() = Eigen::Map<const Eigen::Matrix4d>(node.matrix.data()).topRows<3>();
            return transform;
        }
        if (!node.translation.empty())
            transform.translate(Vec3d(node.translation[0], node.translation[1], node.translation[2]));
        if (!node.rotation.empty())
            transform.rotate(Eigen::Quaterniond(node.rotation[3], node.rotation[0], node.rotation[1], node.rotation[2])
                                 .normalized());
        if (!node.scale.empty()) transform.scale(Vec3d(node.scale[0], node.scale[1], node.scale[2]));
        return transform;
    }

    void read_mesh(int index, const Eigen::Affine3d& transform) {
        for (const tinygltf::Primitive& primitive : gltf_.item(model_.meshes, index, "mesh").primitives) {
            if (GltfReader::has_triangles(primitive))
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
        const std::vector<std::uint32_t> vertices = read_vertices(position->second, transform);
        const bool mirrored = transform.linear().determinant() < 0;  // such a transform reverses every triangle
        for (Face face : gltf_.triangles(primitive, vertices.size())) {
            if (mirrored) std::swap(face[1], face[2]);
            for (std::uint32_t& corner : face) corner = vertices[corner];
            polygons_.add(face);
            materials_.push_back(primitive.material);
        }
    }

    /// Vertices of the mesh, one per element of the accessor.
    std::vector<std::uint32_t> read_vertices(int accessor, const Eigen::Affine3d& transform) {
        const bool moves = !transform.matrix().isIdentity(0);
        std::vector<std::uint32_t> vertices;
        for (Vec3 position : gltf_.vectors(accessor)) {
            if (moves) position = (transform * position.cast<double>()).cast<float>();
            vertices.push_back(welder_.add(position, polygons_.vertices));
        }
        return vertices;
    }

    /// A label per named material, in the order of the materials.
    FaceLabels labels() const {
        FaceLabels labels;
        std::vector<std::int32_t> label_of_material;
        for (const tinygltf::Material& material : model_.materials) {
            if (!material.name.empty() && !is_label_name(material.name))
                gltf_.fail("no label can have the name " + quote(material.name) + "; rename that material");
            label_of_material.push_back(material.name.empty() ? -1 : static_cast<std::int32_t>(labels.names.size()));
            if (!material.name.empty()) labels.names.push_back(material.name);
        }
        for (int material : materials_) {
            const bool exists = material >= 0 && static_cast<std::size_t>(material) < label_of_material.size();
            labels.label.push_back(exists ? label_of_material[static_cast<std::size_t>(material)] : -1);
        }
        return labels;
    }

    static constexpr int k_deepest = 256;

    const tinygltf::Model& model_;
    GltfReader gltf_;
    PolygonList polygons_;
    VertexWelder welder_;
    std::vector<int> materials_;  ///< per polygon; -1 for none
    std::vector<bool> visited_;
    std::size_t skipped_ = 0, placeless_ = 0, skinned_ = 0;
    int depth_ = 0;
};

}  // namespace

/// Reads all triangles of the default scene into one mesh, transformed by their nodes, vertices welded by exact
/// position. Material names become labels if Exemplar wrote the file.
MeshFile read_gltf(std::string_view content, const std::string& name, const std::filesystem::path& folder) {
    const tinygltf::Model model = load_gltf(content, name, folder, GltfContent::geometry);
    return SceneReader(model, name).read();
}

}  // namespace exemplar::mesh_io
