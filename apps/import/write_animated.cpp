// Writes a scene as binary glTF, which the readers of Exemplar evaluate. The file only serves to hand the scene over:
// its skin names a node once for each inverse bind matrix, and accessors have no bounds.
#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "apps/import/tracks.h"
#include "apps/import/write.h"
#include "host/core/json_text.h"
#include "host/mesh/gltf/gltf_file.h"
#include "host/mesh/io/io_polygons.h"
#include "host/mesh/io/io_write_text.h"

namespace exemplar::import {
namespace {

using OrderedJson = nlohmann::ordered_json;

constexpr int k_float = 5126, k_uint16 = 5123, k_uint32 = 5125;

/// Returns a matrix by columns, as glTF stores it.
template <typename Scalar>
std::array<Scalar, 16> columns_of(const aiMatrix4x4t<Scalar>& matrix) {
    std::array<Scalar, 16> columns;
    for (unsigned row = 0; row < 4; ++row)
        for (unsigned column = 0; column < 4; ++column) columns[4 * column + row] = matrix[row][column];
    return columns;
}

/// Returns the corners of the triangles of a mesh. They are cut at rest, as those of a still.
std::vector<std::uint32_t> triangle_corners(const Scene& scene, const SceneMesh& placed, bool turned) {
    std::vector<Vec3> vertices;
    for (const Position& p : positions_at_rest(scene, placed)) vertices.push_back(Vec3d(p.x, p.y, p.z).cast<float>());
    std::vector<Face> faces;
    for (const std::vector<std::uint32_t>& polygon : polygons_of(*placed.mesh, turned))
        mesh_io::triangulate_polygon(vertices, polygon, faces);
    std::vector<std::uint32_t> corners;
    for (const Face& face : faces) corners.insert(corners.end(), face.begin(), face.end());
    return corners;
}

class GlbBuilder {
  public:
    explicit GlbBuilder(const Scene& scene) : scene_(scene) {
        document_["asset"] = {{"version", "2.0"}};
        for (const char* list : {"nodes", "meshes", "accessors", "bufferViews", "animations"})
            document_[list] = OrderedJson::array();
    }

    std::string bytes() {
        add_nodes();
        add_meshes();
        add_skin();
        for (unsigned i = 0; i < scene_.source->mNumAnimations; ++i) add_animation(*scene_.source->mAnimations[i]);
        if (binary_.size() > std::numeric_limits<std::uint32_t>::max() / 2)
            throw std::runtime_error("its animation is larger than 2 GiB");
        document_["buffers"] = {{{"byteLength", binary_.size()}}};
        return mesh_io::binary_gltf(ordered_json_text(document_), binary_);
    }

  private:
    template <typename T>
    std::size_t add_values(const std::vector<T>& values, int component, const char* type, std::size_t width) {
        binary_.resize((binary_.size() + 3) / 4 * 4, '\0');
        const std::size_t begin = binary_.size();
        for (const T& value : values) mesh_io::append_bytes(binary_, value);
        document_["bufferViews"].push_back(
            {{"buffer", 0}, {"byteOffset", begin}, {"byteLength", binary_.size() - begin}});
        document_["accessors"].push_back({{"bufferView", document_["bufferViews"].size() - 1},
                                          {"componentType", component},
                                          {"count", values.size() / width},
                                          {"type", type}});
        return document_["accessors"].size() - 1;
    }

    std::size_t add_vectors(const aiVector3D* vectors, std::size_t count) {
        std::vector<float> numbers;
        for (std::size_t i = 0; i < count; ++i)
            numbers.insert(numbers.end(), {vectors[i].x, vectors[i].y, vectors[i].z});
        return add_values(numbers, k_float, "VEC3", 3);
    }

    /// Adds the nodes in their order; those of skinned meshes, which follow their joints alone, come after them.
    void add_nodes() {
        OrderedJson& nodes = document_["nodes"];
        for (const SceneNode& node : scene_.nodes) {
            nodes.push_back({{"name", node.name}, {"matrix", columns_of(node.local)}});
            if (node.parent >= 0) nodes[static_cast<std::size_t>(node.parent)]["children"].push_back(nodes.size() - 1);
        }
        document_["scenes"] = {{{"nodes", {0}}}};
    }

    void add_meshes() {
        std::map<int, std::vector<const SceneMesh*>> of_nodes;
        for (const SceneMesh& placed : scene_.meshes) {
            if (polygons_of(*placed.mesh, false).empty()) continue;
            if (placed.joints.empty())
                of_nodes[placed.node].push_back(&placed);
            else
                add_skinned(placed);
        }
        for (const auto& [node, meshes] : of_nodes) {
            document_["nodes"][static_cast<std::size_t>(node)]["mesh"] = document_["meshes"].size();
            add_mesh(static_cast<std::size_t>(node), meshes);
        }
    }

    void add_skinned(const SceneMesh& placed) {
        const std::size_t node = document_["nodes"].size();
        document_["scenes"][0]["nodes"].push_back(node);
        document_["nodes"].push_back({{"name", scene_.nodes[static_cast<std::size_t>(placed.node)].name + " (skin)"},
                                      {"mesh", document_["meshes"].size()},
                                      {"skin", 0}});
        add_mesh(node, {&placed});
    }

    /// Adds the meshes of a node as the primitives of one.
    void add_mesh(std::size_t node, const std::vector<const SceneMesh*>& meshes) {
        OrderedJson mesh{{"primitives", OrderedJson::array()}};
        for (const SceneMesh* placed : meshes) mesh["primitives"].push_back(primitive_of(*placed));
        const auto targets = [](const SceneMesh* placed) { return placed->mesh->mNumAnimMeshes; };
        const SceneMesh& most = **std::ranges::max_element(meshes, {}, targets);
        if (targets(&most) > 0) {
            mesh["weights"] = rest_weights(scene_, *most.mesh);
            for (unsigned t = 0; t < most.mesh->mNumAnimMeshes; ++t)
                mesh["extras"]["targetNames"].push_back(most.mesh->mAnimMeshes[t]->mName.C_Str());
            morphed_.emplace_back(node, &most);
        }
        document_["meshes"].push_back(std::move(mesh));
    }

    OrderedJson primitive_of(const SceneMesh& placed) {
        const aiMesh& mesh = *placed.mesh;
        // The reader turns the faces of a mirroring node, but cannot tell that joints mirror.
        const bool turned = !placed.joints.empty() && is_mirrored(scene_, placed);
        OrderedJson primitive{{"attributes", {{"POSITION", add_vectors(mesh.mVertices, mesh.mNumVertices)}}}};
        primitive["indices"] = add_values(triangle_corners(scene_, placed, turned), k_uint32, "SCALAR", 1);
        for (unsigned t = 0; t < mesh.mNumAnimMeshes; ++t) {
            std::vector<aiVector3D> offsets = target_offsets(mesh, t);
            offsets.resize(mesh.mNumVertices);
            primitive["targets"].push_back({{"POSITION", add_vectors(offsets.data(), offsets.size())}});
        }
        if (!placed.joints.empty()) add_influences(placed, primitive["attributes"]);
        return primitive;
    }

    /// Adds joints and weights, four of a vertex in each set.
    void add_influences(const SceneMesh& placed, OrderedJson& attributes) {
        std::vector<std::uint16_t> joint_of_bone;
        for (std::size_t b = 0; b < placed.joints.size(); ++b)
            joint_of_bone.push_back(joint_of(placed.joints[b], placed.mesh->mBones[b]->mOffsetMatrix));
        const std::vector<std::vector<Influence>> influences = influences_of(*placed.mesh);
        std::size_t most = 0;
        for (const auto& row : influences) most = std::max(most, row.size());
        for (std::size_t set = 0; 4 * set < most; ++set) {
            std::vector<std::uint16_t> joints;
            std::vector<float> weights;
            for (const auto& row : influences)
                for (std::size_t i = 4 * set; i < 4 * set + 4; ++i) {
                    const Influence influence = i < row.size() ? row[i] : Influence{};
                    joints.push_back(joint_of_bone[influence.bone]);
                    weights.push_back(influence.weight);
                }
            const std::string suffix = "_" + std::to_string(set);
            attributes["JOINTS" + suffix] = add_values(joints, k_uint16, "VEC4", 4);
            attributes["WEIGHTS" + suffix] = add_values(weights, k_float, "VEC4", 4);
        }
    }

    std::uint16_t joint_of(int node, const aiMatrix4x4& inverse_bind) {
        const std::array<float, 16> columns = columns_of(inverse_bind);
        std::array<std::uint32_t, 16> bits;
        std::memcpy(bits.data(), columns.data(), sizeof(bits));
        const auto [joint, added] = joints_.try_emplace({node, bits}, joint_nodes_.size());
        if (added) {
            if (joint_nodes_.size() > std::numeric_limits<std::uint16_t>::max())
                throw std::runtime_error("its skins have more than 65,536 joints");
            joint_nodes_.push_back(node);
            inverse_binds_.insert(inverse_binds_.end(), columns.begin(), columns.end());
        }
        return static_cast<std::uint16_t>(joint->second);
    }

    void add_skin() {
        if (joint_nodes_.empty()) return;
        document_["skins"] = {
            {{"joints", joint_nodes_}, {"inverseBindMatrices", add_values(inverse_binds_, k_float, "MAT4", 16)}}};
    }

    void add_animation(const aiAnimation& source) {
        OrderedJson animation{
            {"name", source.mName.C_Str()}, {"channels", OrderedJson::array()}, {"samplers", OrderedJson::array()}};
        for (const NodeTracks& tracks : node_tracks(scene_, source)) {
            const auto node = static_cast<std::size_t>(tracks.node);
            add_channel(animation, node, "translation", tracks.translation, "VEC3", 3);
            add_channel(animation, node, "rotation", tracks.rotation, "VEC4", 4);
            add_channel(animation, node, "scale", tracks.scale, "VEC3", 3);
        }
        for (const auto& [node, placed] : morphed_)
            add_channel(animation, node, "weights", weight_track(scene_, source, *placed), "SCALAR", 1);
        if (!animation["channels"].empty()) document_["animations"].push_back(std::move(animation));
    }

    void add_channel(OrderedJson& animation, std::size_t node, const char* path, const Track& track, const char* type,
                     std::size_t width) {
        if (track.times.empty()) return;
        animation["channels"].push_back(
            {{"sampler", animation["samplers"].size()}, {"target", {{"node", node}, {"path", path}}}});
        const std::size_t input = add_values(track.times, k_float, "SCALAR", 1);
        animation["samplers"].push_back({{"input", input}, {"output", add_values(track.values, k_float, type, width)}});
    }

    const Scene& scene_;
    OrderedJson document_;
    std::string binary_;
    std::map<std::pair<int, std::array<std::uint32_t, 16>>, std::size_t> joints_;
    std::vector<int> joint_nodes_;
    std::vector<float> inverse_binds_;
    std::vector<std::pair<std::size_t, const SceneMesh*>> morphed_;  ///< the nodes whose meshes have morph targets
};

}  // namespace

std::string animated_glb(const Scene& scene) {
    return GlbBuilder(scene).bytes();
}

}  // namespace exemplar::import
