#include "host/animation/gltf_rig.h"

#include <fmt/format.h>
#include <tiny_gltf.h>

#include <Eigen/Geometry>
#include <cstring>
#include <map>
#include <set>

#include "host/animation/check_animation.h"
#include "host/animation/gltf_nodes.h"
#include "host/mesh/io/io_text.h"

namespace exemplar::animation_io {
namespace {

using mesh_io::GltfReader;

/// Exporters leave smaller weights than this on joints that move nothing.
constexpr float k_used_weight = 1e-3f;

/// Collects the vertices, faces, bones and morph targets of a scene.
class RigReader {
  public:
    RigReader(GltfReader& gltf, Animation& animation)
        : gltf_(gltf),
          model_(gltf.model()),
          tree_(read_gltf_tree(gltf)),
          mirrors_(mirroring_nodes()),
          animation_(animation) {
        links_.bones_of_skin.resize(model_.skins.size());
        links_.rig_node.assign(model_.nodes.size(), k_invalid_index);
        links_.targets.resize(model_.nodes.size());
    }

    GltfLinks read() {
        rig().influence_begin = {0};
        for (const std::uint32_t node : tree_.order)
            if (tree_.in_scene[node] && model_.nodes[node].mesh >= 0) read_mesh(node);
        if (unplaced_)
            animation_.warnings.push_back(fmt::format("{} primitives without POSITION were left out", unplaced_));
        if (skipped_)
            animation_.warnings.push_back(fmt::format("{} primitives of points or lines were left out", skipped_));
        keep_nodes();
        clean_influences(rig(), animation_.name, animation_.warnings);
        return std::move(links_);
    }

  private:
    Rig& rig() { return animation_.rig; }

    void read_mesh(std::uint32_t node_index) {
        const tinygltf::Node& node = model_.nodes[node_index];
        const tinygltf::Mesh& mesh = gltf_.item(model_.meshes, node.mesh, "mesh");
        if (node.skin >= 0) read_skin(node.skin);
        add_targets(node_index, mesh);
        for (const tinygltf::Primitive& primitive : mesh.primitives) {
            const bool placed = primitive.attributes.contains("POSITION");
            skipped_ += !GltfReader::has_triangles(primitive);
            unplaced_ += GltfReader::has_triangles(primitive) && !placed;
            if (GltfReader::has_triangles(primitive) && placed) read_primitive(node_index, primitive);
        }
    }

    void read_primitive(std::uint32_t node, const tinygltf::Primitive& primitive) {
        std::vector<Vec3>& vertices = animation_.rest.vertices;
        const auto first = static_cast<std::uint32_t>(vertices.size());
        const std::vector<Vec3> positions = gltf_.vectors(primitive.attributes.at("POSITION"));
        vertices.insert(vertices.end(), positions.begin(), positions.end());
        for (Face face : gltf_.triangles(primitive, positions.size())) {
            for (std::uint32_t& corner : face) corner += first;
            if (mirrors_[node]) std::swap(face[1], face[2]);
            animation_.rest.faces.push_back(face);
        }
        if (model_.nodes[node].skin >= 0 && primitive.attributes.contains("JOINTS_0"))
            bind_to_joints(model_.nodes[node].skin, primitive, positions.size());
        else
            bind_to_node(node, positions.size());
        for (std::size_t t = 0; t < primitive.targets.size(); ++t)
            if (const auto offsets = primitive.targets[t].find("POSITION"); offsets != primitive.targets[t].end())
                read_offsets(rig().targets[links_.targets[node].begin + t], offsets->second, first, positions.size());
    }

    /// Adds as many morph targets as the primitive with most of them has; other primitives are not moved by the
    /// rest.
    void add_targets(std::uint32_t node_index, const tinygltf::Mesh& mesh) {
        std::size_t count = 0;
        for (const tinygltf::Primitive& primitive : mesh.primitives) count = std::max(count, primitive.targets.size());
        const tinygltf::Node& node = model_.nodes[node_index];
        const std::vector<double>& weights = node.weights.empty() ? mesh.weights : node.weights;
        if (!weights.empty() && weights.size() != count)
            gltf_.fail(fmt::format("node {} has {} weights for {} morph targets", node_index, weights.size(), count));
        links_.targets[node_index] = {static_cast<std::uint32_t>(rig().targets.size()),
                                      static_cast<std::uint32_t>(count)};
        for (std::size_t t = 0; t < count; ++t) {
            const std::string name = target_name(mesh, t);
            rig().targets.push_back({.name = name.empty() ? fmt::format("target_{}", t) : name,
                                     .vertices = {},
                                     .offsets = {},
                                     .rest_weight = weights.empty() ? 0.0f : static_cast<float>(weights[t])});
            links_.target_node.push_back(node_index);
            links_.target_is_named.push_back(!name.empty());
        }
    }

    static std::string target_name(const tinygltf::Mesh& mesh, std::size_t target) {
        if (!mesh.extras.IsObject() || !mesh.extras.Has("targetNames")) return {};
        const tinygltf::Value& names = mesh.extras.Get("targetNames");
        if (!names.IsArray() || target >= names.ArrayLen()) return {};
        const tinygltf::Value& name = names.Get(static_cast<int>(target));
        return name.IsString() ? name.Get<std::string>() : std::string();
    }

    void read_offsets(MorphTarget& target, int accessor, std::uint32_t first, std::size_t vertex_count) {
        const std::vector<Vec3> offsets = gltf_.vectors(accessor);
        if (offsets.size() != vertex_count)
            gltf_.fail(fmt::format("morph target {} moves {} vertices of {} (accessor {})", mesh_io::quote(target.name),
                                   offsets.size(), vertex_count, accessor));
        for (std::size_t v = 0; v < vertex_count; ++v) {
            if (offsets[v] == Vec3::Zero()) continue;
            target.vertices.push_back(first + static_cast<std::uint32_t>(v));
            target.offsets.push_back(offsets[v]);
        }
    }

    /// Returns the bone with this node and matrix; equal bones of several skins are one. Until keep_nodes, bones
    /// refer to nodes of the file.
    std::uint32_t bone_of(std::uint32_t node, const Affine& inverse_bind) {
        std::array<float, 12> numbers;
        std::memcpy(numbers.data(), inverse_bind.data(), sizeof(numbers));
        std::array<std::uint32_t, 12> bits;
        std::memcpy(bits.data(), numbers.data(), sizeof(bits));
        const auto [it, added] = bone_index_.try_emplace({node, bits}, static_cast<std::uint32_t>(rig().bones.size()));
        if (added) rig().bones.push_back({node, inverse_bind});
        return it->second;
    }

    void read_skin(int index) {
        const tinygltf::Skin& skin = gltf_.item(model_.skins, index, "skin");
        std::vector<std::uint32_t>& bones = links_.bones_of_skin[static_cast<std::size_t>(index)];
        if (!bones.empty()) return;
        if (skin.joints.empty()) gltf_.fail(fmt::format("skin {} has no joints", index));
        std::vector<float> matrices;
        if (skin.inverseBindMatrices >= 0) {
            matrices = gltf_.numbers(skin.inverseBindMatrices, 16);
            if (matrices.size() < 16 * skin.joints.size())
                gltf_.fail(fmt::format("skin {} has {} inverse bind matrices for {} joints", index,
                                       matrices.size() / 16, skin.joints.size()));
        }
        for (std::size_t j = 0; j < skin.joints.size(); ++j) {
            gltf_.item(model_.nodes, skin.joints[j], "node");
            Affine inverse_bind = Affine::Identity();
            if (!matrices.empty())
                inverse_bind.matrix() = Eigen::Map<const Eigen::Matrix4f>(matrices.data() + 16 * j).topRows<3>();
            bones.push_back(bone_of(static_cast<std::uint32_t>(skin.joints[j]), inverse_bind));
        }
    }

    void bind_to_node(std::uint32_t node, std::size_t vertex_count) {
        const std::uint32_t bone = bone_of(node, Affine::Identity());
        for (std::size_t v = 0; v < vertex_count; ++v) {
            rig().influences.push_back({bone, 1.0f});
            end_vertex();
        }
    }

    void end_vertex() { rig().influence_begin.push_back(static_cast<std::uint32_t>(rig().influences.size())); }

    /// Four joints and weights per vertex, from one of the attribute sets _0, _1, ...
    struct JointSet {
        std::vector<std::uint32_t> joints;
        std::vector<float> weights;
    };
    std::vector<JointSet> joint_sets(const tinygltf::Primitive& primitive, std::size_t vertex_count) {
        std::vector<JointSet> sets;
        for (;;) {
            const auto joints = primitive.attributes.find(fmt::format("JOINTS_{}", sets.size()));
            const auto weights = primitive.attributes.find(fmt::format("WEIGHTS_{}", sets.size()));
            if (joints == primitive.attributes.end()) return sets;
            if (weights == primitive.attributes.end())
                gltf_.fail(fmt::format("a primitive has JOINTS_{0} without WEIGHTS_{0}", sets.size()));
            JointSet set{gltf_.integers(joints->second, 4), gltf_.numbers(weights->second, 4)};
            if (set.joints.size() != 4 * vertex_count || set.weights.size() != 4 * vertex_count)
                gltf_.fail(fmt::format("a primitive has joints for {} and weights for {} of {} vertices",
                                       set.joints.size() / 4, set.weights.size() / 4, vertex_count));
            sets.push_back(std::move(set));
        }
    }

    void bind_to_joints(int skin, const tinygltf::Primitive& primitive, std::size_t vertex_count) {
        const std::vector<std::uint32_t>& bones = links_.bones_of_skin[static_cast<std::size_t>(skin)];
        const std::vector<JointSet> sets = joint_sets(primitive, vertex_count);
        for (std::size_t v = 0; v < vertex_count; ++v) {
            bool is_bound = false;
            for (const JointSet& set : sets)
                for (std::size_t i = 4 * v; i < 4 * v + 4; ++i) {
                    if (set.weights[i] == 0) continue;  // exporters write any joint number with a zero weight
                    if (set.joints[i] >= bones.size())
                        gltf_.fail(
                            fmt::format("joint {} is named, but skin {} has {}", set.joints[i], skin, bones.size()));
                    rig().influences.push_back({bones[set.joints[i]], set.weights[i]});
                    is_bound = true;
                }
            if (!is_bound) rig().influences.push_back({bones.front(), 0.0f});
            end_vertex();
        }
    }

    /// Adds the nodes that bones depend on to the rig.
    void keep_nodes() {
        std::vector<bool> needed(model_.nodes.size(), false);
        for (const Bone& bone : rig().bones)
            for (std::uint32_t node = bone.node; node != k_invalid_index && !needed[node]; node = tree_.parent[node])
                needed[node] = true;
        for (const std::uint32_t node : tree_.order) {
            if (!needed[node]) continue;
            links_.rig_node[node] = static_cast<std::uint32_t>(rig().nodes.size());
            const std::uint32_t parent = tree_.parent[node];
            rig().nodes.push_back({.name = model_.nodes[node].name,
                                   .parent = parent == k_invalid_index ? k_invalid_index : links_.rig_node[parent],
                                   .rest = read_gltf_transform(gltf_, static_cast<int>(node), animation_.warnings)});
        }
        for (Bone& bone : rig().bones) bone.node = links_.rig_node[bone.node];
    }

    /// Returns for each node of the file whether its world transform mirrors, which reverses the faces of its mesh.
    /// In glTF this holds for skinned meshes, too, although they otherwise ignore their node.
    std::vector<bool> mirroring_nodes() const {
        std::vector<bool> mirrors(model_.nodes.size(), false);
        std::vector<std::string> ignored;  // keep_nodes warns of the nodes that matter
        for (const std::uint32_t node : tree_.order) {
            const bool itself = read_gltf_transform(gltf_, static_cast<int>(node), ignored).scale.prod() < 0;
            const std::uint32_t parent = tree_.parent[node];
            mirrors[node] = itself != (parent != k_invalid_index && mirrors[parent]);
        }
        return mirrors;
    }

    GltfReader& gltf_;
    const tinygltf::Model& model_;
    GltfTree tree_;
    std::vector<bool> mirrors_;
    Animation& animation_;
    GltfLinks links_;
    std::map<std::pair<std::uint32_t, std::array<std::uint32_t, 12>>, std::uint32_t> bone_index_;
    std::size_t skipped_ = 0, unplaced_ = 0;
};

}  // namespace

GltfLinks read_gltf_rig(GltfReader& gltf, Animation& animation) {
    return RigReader(gltf, animation).read();
}

AnimationKind gltf_kind(const mesh_io::GltfReader& gltf, const GltfLinks& links, const Rig& rig) {
    if (gltf.model().asset.generator == k_blend_shapes_generator && !rig.targets.empty())
        return AnimationKind::blend_shapes;
    std::vector<bool> is_used(rig.bones.size(), false);
    for (const Influence& influence : rig.influences)
        if (influence.weight > k_used_weight) is_used[influence.bone] = true;
    for (const std::vector<std::uint32_t>& bones : links.bones_of_skin) {
        std::set<std::uint32_t> used;
        for (const std::uint32_t bone : bones)
            if (is_used[bone]) used.insert(bone);
        if (used.size() >= 2) return AnimationKind::skeleton;
    }
    if (!rig.targets.empty()) return AnimationKind::blend_shapes;
    gltf.fail("there is neither a skin of several joints nor a morph target; export with the armature or shape keys");
}

}  // namespace exemplar::animation_io
