#include "host/mesh/gltf/gltf_surface.h"

#include <fmt/format.h>
#include <tiny_gltf.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <map>
#include <utility>

#include "host/mesh/io/io_text.h"

namespace exemplar::mesh_io {
namespace {

constexpr const char* k_instancing = "EXT_mesh_gpu_instancing";

/// Collects the vertices, faces, bones and morph targets of a scene.
class SurfaceReader {
  public:
    SurfaceReader(GltfReader& gltf, const std::string& name) : gltf_(gltf), model_(gltf.model()), name_(name) {
        surface_.tree = read_gltf_tree(gltf);
        surface_.world = gltf_world_transforms(gltf, surface_.tree);
        surface_.bones_of_skin.resize(model_.skins.size());
        surface_.targets.resize(model_.nodes.size());
        skin().influence_begin = {0};
    }

    GltfSurface read() {
        bool any = false;
        for (const std::uint32_t node : surface_.tree.order) {
            if (!surface_.tree.in_scene[node] || model_.nodes[node].mesh < 0) continue;
            read_node(node);
            any = true;
        }
        if (!any) gltf_.fail("no node of its scene has a mesh, so that it shows nothing; export the objects as well");
        const auto warn = [&](std::size_t count, const char* what) {
            if (count) surface_.warnings.push_back(fmt::format("{} {} were left out", count, what));
        };
        warn(skipped_, "primitives of points or lines");
        warn(unplaced_, "primitives without POSITION");
        warn(copied_skins_, "nodes' copies of skinned meshes (EXT_mesh_gpu_instancing)");
        clean_influences(skin(), name_, surface_.warnings);
        return std::move(surface_);
    }

  private:
    Skin& skin() { return surface_.skin; }

    void read_node(std::uint32_t node_index) {
        const tinygltf::Node& node = model_.nodes[node_index];
        const tinygltf::Mesh& mesh = gltf_.item(model_.meshes, node.mesh, "mesh");
        if (node.skin >= 0) read_skin(node.skin);
        add_targets(node_index, mesh);
        for (const Affine& copy : copies(node, node_index))
            for (const tinygltf::Primitive& primitive : mesh.primitives) read_primitive(node_index, copy, primitive);
    }

    /// Returns the transforms of the copies of a node's mesh; the identity if it has none.
    std::vector<Affine> copies(const tinygltf::Node& node, std::uint32_t index) {
        const auto extension = node.extensions.find(k_instancing);
        if (extension == node.extensions.end()) return {Affine::Identity()};
        if (node.skin >= 0) {
            ++copied_skins_;
            return {Affine::Identity()};
        }
        const tinygltf::Value attributes =
            extension->second.Has("attributes") ? extension->second.Get("attributes") : tinygltf::Value();
        const auto read = [&](const char* key, int components) {
            const bool exists = attributes.IsObject() && attributes.Has(key) && attributes.Get(key).IsInt();
            return exists ? gltf_.numbers(attributes.Get(key).GetNumberAsInt(), components) : std::vector<float>();
        };
        const std::vector<float> translations = read("TRANSLATION", 3), rotations = read("ROTATION", 4),
                                 scales = read("SCALE", 3);
        const std::size_t count = std::max({translations.size() / 3, rotations.size() / 4, scales.size() / 3});
        const auto fits = [&](const std::vector<float>& values, std::size_t width) {
            return values.empty() || values.size() == width * count;
        };
        if (count == 0 || !fits(translations, 3) || !fits(rotations, 4) || !fits(scales, 3))
            gltf_.fail(fmt::format("the attributes of {} of node {} are missing or of different lengths", k_instancing,
                                   index));
        std::vector<Affine> transforms(count, Affine::Identity());
        for (std::size_t i = 0; i < count; ++i) {
            if (!translations.empty()) transforms[i].translate(Eigen::Map<const Vec3>(translations.data() + 3 * i));
            if (!rotations.empty())
                transforms[i].rotate(Eigen::Map<const Eigen::Quaternionf>(rotations.data() + 4 * i).normalized());
            if (!scales.empty()) transforms[i].scale(Vec3(Eigen::Map<const Vec3>(scales.data() + 3 * i)));
        }
        return transforms;
    }

    void read_primitive(std::uint32_t node, const Affine& copy, const tinygltf::Primitive& primitive) {
        const auto position = primitive.attributes.find("POSITION");
        if (!GltfReader::has_triangles(primitive)) {
            ++skipped_;
            return;
        }
        if (position == primitive.attributes.end()) {
            ++unplaced_;
            return;
        }
        const auto first = static_cast<std::uint32_t>(surface_.vertices.size());
        const std::vector<Vec3> positions = gltf_.vectors(position->second);
        surface_.vertices.insert(surface_.vertices.end(), positions.begin(), positions.end());
        read_values(primitive, first, positions.size());
        read_faces(node, copy, primitive, first, positions.size());
        if (model_.nodes[node].skin >= 0 && primitive.attributes.contains("JOINTS_0"))
            bind_to_joints(model_.nodes[node].skin, primitive, positions.size());
        else
            bind_to_node(node, copy, positions.size());
        for (std::size_t t = 0; t < primitive.targets.size(); ++t)
            if (const auto offsets = primitive.targets[t].find("POSITION"); offsets != primitive.targets[t].end())
                read_offsets(skin().targets[surface_.targets[node].begin + t], offsets->second, first,
                             positions.size());
    }

    /// Reads the values of vertices, if they are numbers.
    void read_values(const tinygltf::Primitive& primitive, std::uint32_t first, std::size_t vertex_count) {
        for (const char* key : {"_LABEL", "_GROUP", "_PART"}) {
            const auto found = primitive.attributes.find(key);
            if (found == primitive.attributes.end()) continue;
            const tinygltf::Accessor& accessor = gltf_.item(model_.accessors, found->second, "accessor");
            const bool is_number = accessor.type == TINYGLTF_TYPE_SCALAR && accessor.count == vertex_count &&
                                   (accessor.componentType == TINYGLTF_COMPONENT_TYPE_FLOAT ||
                                    accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
                                    accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT);
            if (!is_number) continue;
            const std::vector<float> values = gltf_.numbers(found->second, 1, GltfIntegers::any);
            surface_.vertex_values.resize(first, std::numeric_limits<float>::quiet_NaN());
            surface_.vertex_values.insert(surface_.vertex_values.end(), values.begin(), values.end());
            break;
        }
        if (!surface_.vertex_values.empty())
            surface_.vertex_values.resize(first + vertex_count, std::numeric_limits<float>::quiet_NaN());
    }

    /// A transform that mirrors reverses the faces. In glTF this holds for skinned meshes, too, although they otherwise
    /// ignore their node (section 3.7.4).
    void read_faces(std::uint32_t node, const Affine& copy, const tinygltf::Primitive& primitive, std::uint32_t first,
                    std::size_t vertex_count) {
        const bool mirrors =
            (surface_.world[node].linear().determinant() < 0) != (copy.linear().cast<double>().determinant() < 0);
        for (Face face : gltf_.triangles(primitive, vertex_count)) {
            for (std::uint32_t& corner : face) corner += first;
            if (mirrors) std::swap(face[1], face[2]);
            surface_.faces.push_back(face);
            surface_.materials.push_back(primitive.material);
        }
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
        surface_.targets[node_index] = {static_cast<std::uint32_t>(skin().targets.size()),
                                        static_cast<std::uint32_t>(count)};
        for (std::size_t t = 0; t < count; ++t) {
            const std::string name = target_name(mesh, t);
            skin().targets.push_back({.name = name.empty() ? fmt::format("target_{}", t) : name,
                                      .vertices = {},
                                      .offsets = {},
                                      .rest_weight = weights.empty() ? 0.0f : static_cast<float>(weights[t])});
            surface_.target_node.push_back(node_index);
            surface_.target_is_named.push_back(!name.empty());
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
            gltf_.fail(fmt::format("morph target {} moves {} vertices of {} (accessor {})", quote(target.name),
                                   offsets.size(), vertex_count, accessor));
        for (std::size_t v = 0; v < vertex_count; ++v) {
            if (offsets[v] == Vec3::Zero()) continue;
            target.vertices.push_back(first + static_cast<std::uint32_t>(v));
            target.offsets.push_back(offsets[v]);
        }
    }

    /// Returns the bone with this node and matrix.
    std::uint32_t bone_of(std::uint32_t node, const Affine& inverse_bind) {
        std::array<std::uint32_t, 12> bits;
        std::memcpy(bits.data(), inverse_bind.data(), sizeof(bits));
        const auto [it, added] = bone_index_.try_emplace({node, bits}, static_cast<std::uint32_t>(skin().bones.size()));
        if (added) skin().bones.push_back({node, inverse_bind});
        return it->second;
    }

    void read_skin(int index) {
        const tinygltf::Skin& skin = gltf_.item(model_.skins, index, "skin");
        std::vector<std::uint32_t>& bones = surface_.bones_of_skin[static_cast<std::size_t>(index)];
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

    void bind_to_node(std::uint32_t node, const Affine& copy, std::size_t vertex_count) {
        const std::uint32_t bone = bone_of(node, copy);
        for (std::size_t v = 0; v < vertex_count; ++v) {
            skin().influences.push_back({bone, 1.0f});
            end_vertex();
        }
    }

    void end_vertex() { skin().influence_begin.push_back(static_cast<std::uint32_t>(skin().influences.size())); }

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

    void bind_to_joints(int index, const tinygltf::Primitive& primitive, std::size_t vertex_count) {
        const std::vector<std::uint32_t>& bones = surface_.bones_of_skin[static_cast<std::size_t>(index)];
        const std::vector<JointSet> sets = joint_sets(primitive, vertex_count);
        for (std::size_t v = 0; v < vertex_count; ++v) {
            bool is_bound = false;
            for (const JointSet& set : sets)
                for (std::size_t i = 4 * v; i < 4 * v + 4; ++i) {
                    if (set.weights[i] == 0) continue;  // exporters write any joint number with a zero weight
                    if (set.joints[i] >= bones.size())
                        gltf_.fail(
                            fmt::format("joint {} is named, but skin {} has {}", set.joints[i], index, bones.size()));
                    skin().influences.push_back({bones[set.joints[i]], set.weights[i]});
                    is_bound = true;
                }
            if (!is_bound) skin().influences.push_back({bones.front(), 0.0f});
            end_vertex();
        }
    }

    GltfReader& gltf_;
    const tinygltf::Model& model_;
    const std::string& name_;
    GltfSurface surface_;
    std::map<std::pair<std::uint32_t, std::array<std::uint32_t, 12>>, std::uint32_t> bone_index_;
    std::size_t skipped_ = 0, unplaced_ = 0, copied_skins_ = 0;
};

}  // namespace

GltfSurface read_gltf_surface(GltfReader& gltf, const std::string& name) {
    return SurfaceReader(gltf, name).read();
}

std::vector<Vec3> vertices_at_rest(const GltfSurface& surface) {
    std::vector<float> weights;
    for (const MorphTarget& target : surface.skin.targets) weights.push_back(target.rest_weight);
    std::vector<Affine3> bones;
    for (const Bone& bone : surface.skin.bones)
        bones.push_back(surface.world[bone.node] * bone.inverse_bind.cast<double>());
    std::vector<Vec3> vertices;
    morph(surface.skin, surface.vertices, weights, vertices);
    // Coordinates that are not finite, or -0, stay as they are where nothing moves.
    const auto rests = [](const Affine3& bone) { return bone.matrix() == Affine3::Identity().matrix(); };
    if (!std::ranges::all_of(bones, rests)) skin_vertices(surface.skin, bones, vertices);
    return vertices;
}

}  // namespace exemplar::mesh_io
