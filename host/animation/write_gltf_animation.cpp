// Writes binary glTF 2.0: a mesh, a skin whose joints are the bones, and an animation per clip with a key per frame.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "host/animation/check_animation.h"
#include "host/animation/gltf_rig.h"
#include "host/animation/write_animation.h"
#include "host/core/errors.h"
#include "host/core/files.h"
#include "host/core/json_text.h"
#include "host/mesh/gltf/gltf_file.h"
#include "host/mesh/io/io_write_text.h"

namespace exemplar {
namespace {

using OrderedJson = nlohmann::ordered_json;

constexpr int k_float = 5126, k_uint16 = 5123, k_uint32 = 5125;

std::vector<float> numbers_of(const Vec3& v) {
    return {v[0], v[1], v[2]};
}
std::vector<float> numbers_of(const Eigen::Quaternionf& q) {
    return {q.x(), q.y(), q.z(), q.w()};
}

/// Builds the JSON document and the binary chunk together.
class GltfBuilder {
  public:
    explicit GltfBuilder(const Animation& animation) : animation_(animation), rig_(animation.rig) {
        const bool is_skeleton = animation.kind == AnimationKind::skeleton;
        document_["asset"] = {{"version", "2.0"},
                              {"generator", is_skeleton ? std::string_view("Animation written by Exemplar")
                                                        : animation_io::k_blend_shapes_generator}};
        for (const char* list : {"accessors", "bufferViews"}) document_[list] = OrderedJson::array();
    }

    std::string bytes() {
        add_nodes();
        add_skin();
        add_mesh();
        for (const Clip& clip : animation_.clips) add_clip(clip);
        document_["buffers"] = {{{"byteLength", binary_.size()}}};
        return mesh_io::binary_gltf(ordered_json_text(document_), binary_);
    }

  private:
    /// Appends values to the binary chunk, aligned to four bytes, and returns their buffer view.
    template <typename T>
    std::size_t add_view(const std::vector<T>& values) {
        binary_.resize((binary_.size() + 3) / 4 * 4, '\0');
        const std::size_t begin = binary_.size();
        for (const T& value : values) mesh_io::append_bytes(binary_, value);
        document_["bufferViews"].push_back(
            {{"buffer", 0}, {"byteOffset", begin}, {"byteLength", binary_.size() - begin}});
        return document_["bufferViews"].size() - 1;
    }

    std::size_t add_accessor(OrderedJson accessor) {
        document_["accessors"].push_back(std::move(accessor));
        return document_["accessors"].size() - 1;
    }

    template <typename T>
    std::size_t add_values(const std::vector<T>& values, int component, const char* type, std::size_t width) {
        return add_accessor({{"bufferView", add_view(values)},
                             {"componentType", component},
                             {"count", values.size() / width},
                             {"type", type}});
    }

    /// Adds bounds to an accessor; glTF requires them for positions and times.
    void add_bounds(std::size_t accessor, const std::vector<float>& values, std::size_t width) {
        std::vector<float> low(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(width)), high = low;
        for (std::size_t i = 0; i < values.size(); ++i) {
            low[i % width] = std::min(low[i % width], values[i]);
            high[i % width] = std::max(high[i % width], values[i]);
        }
        document_["accessors"][accessor]["min"] = low;
        document_["accessors"][accessor]["max"] = high;
    }

    static OrderedJson node_json(const std::string& name, const NodeTransform& place) {
        return {{"name", name},
                {"translation", numbers_of(place.translation)},
                {"rotation", numbers_of(place.rotation)},
                {"scale", numbers_of(place.scale)}};
    }

    /// Adds the nodes of the rig in their order, then those added for bones, then that of the mesh.
    void add_nodes() {
        OrderedJson& nodes = document_["nodes"] = OrderedJson::array();
        OrderedJson roots = OrderedJson::array();
        std::vector<std::vector<std::size_t>> children(rig_.nodes.size());
        for (std::size_t i = 0; i < rig_.nodes.size(); ++i) {
            nodes.push_back(node_json(rig_.nodes[i].name, rig_.nodes[i].rest));
            if (rig_.nodes[i].parent == k_invalid_index)
                roots.push_back(i);
            else
                children[rig_.nodes[i].parent].push_back(i);
        }
        std::vector<bool> is_joint(rig_.nodes.size(), false);
        for (const Bone& bone : rig_.bones) {
            joints_.push_back(bone.node);
            if (is_joint[bone.node]) {  // a skin may name a node only once
                joints_.back() = nodes.size();
                children[bone.node].push_back(nodes.size());
                nodes.push_back({{"name", rig_.nodes[bone.node].name + " (joint)"}});
            }
            is_joint[bone.node] = true;
        }
        for (std::size_t i = 0; i < children.size(); ++i)
            if (!children[i].empty()) nodes[i]["children"] = children[i];
        mesh_node_ = nodes.size();
        roots.push_back(mesh_node_);
        nodes.push_back({{"name", "surface"}, {"mesh", 0}, {"skin", 0}});
        document_["scene"] = 0;
        document_["scenes"] = {{{"nodes", roots}}};
    }

    void add_skin() {
        std::vector<float> matrices;
        for (const Bone& bone : rig_.bones) {
            Eigen::Matrix4f matrix = Eigen::Matrix4f::Identity();
            matrix.topRows<3>() = bone.inverse_bind.matrix();
            matrices.insert(matrices.end(), matrix.data(), matrix.data() + 16);
        }
        document_["skins"] = {
            {{"joints", joints_}, {"inverseBindMatrices", add_values(matrices, k_float, "MAT4", 16)}}};
    }

    void add_mesh() {
        std::vector<float> positions;
        for (const Vec3& p : animation_.rest.vertices) positions.insert(positions.end(), p.data(), p.data() + 3);
        std::vector<std::uint32_t> corners;
        for (const Face& face : animation_.rest.faces) corners.insert(corners.end(), face.begin(), face.end());
        OrderedJson attributes;
        const std::size_t position = add_values(positions, k_float, "VEC3", 3);
        add_bounds(position, positions, 3);
        attributes["POSITION"] = position;
        add_influences(attributes);
        OrderedJson primitive{{"attributes", attributes}, {"indices", add_values(corners, k_uint32, "SCALAR", 1)}};
        OrderedJson mesh;
        for (const MorphTarget& target : rig_.targets) {
            primitive["targets"].push_back({{"POSITION", add_target(target)}});
            mesh["weights"].push_back(target.rest_weight);
            mesh["extras"]["targetNames"].push_back(target.name);
        }
        mesh["primitives"] = OrderedJson::array({primitive});
        document_["meshes"] = OrderedJson::array({mesh});
    }

    /// Adds sets of four joints and weights, as many as the vertex with most influences needs.
    void add_influences(OrderedJson& attributes) {
        const std::size_t vertex_count = animation_.rest.vertex_count();
        std::size_t most = 1;
        for (std::size_t v = 0; v < vertex_count; ++v) most = std::max(most, rig_.influences_of(v).size());
        for (std::size_t set = 0; 4 * set < most; ++set) {
            std::vector<std::uint16_t> joints(4 * vertex_count, 0);
            std::vector<float> weights(4 * vertex_count, 0);
            for (std::size_t v = 0; v < vertex_count; ++v) {
                const auto row = rig_.influences_of(v);
                for (std::size_t i = 0; i < 4 && 4 * set + i < row.size(); ++i) {
                    joints[4 * v + i] = static_cast<std::uint16_t>(row[4 * set + i].bone);
                    weights[4 * v + i] = row[4 * set + i].weight;
                }
            }
            attributes[fmt::format("JOINTS_{}", set)] = add_values(joints, k_uint16, "VEC4", 4);
            attributes[fmt::format("WEIGHTS_{}", set)] = add_values(weights, k_float, "VEC4", 4);
        }
    }

    /// Adds a sparse accessor. It cannot be empty, so for a target that moves nothing it holds one vertex with
    /// offset zero.
    std::size_t add_target(const MorphTarget& target) {
        std::vector<std::uint32_t> vertices = target.vertices;
        std::vector<float> offsets;
        for (const Vec3& offset : target.offsets) offsets.insert(offsets.end(), offset.data(), offset.data() + 3);
        if (vertices.empty()) {
            vertices = {0};
            offsets = {0, 0, 0};
        }
        const std::size_t accessor =
            add_accessor({{"componentType", k_float},
                          {"count", animation_.rest.vertex_count()},
                          {"type", "VEC3"},
                          {"sparse",
                           {{"count", vertices.size()},
                            {"indices", {{"bufferView", add_view(vertices)}, {"componentType", k_uint32}}},
                            {"values", {{"bufferView", add_view(offsets)}}}}}});
        if (vertices.size() < animation_.rest.vertex_count()) offsets.insert(offsets.end(), {0, 0, 0});
        add_bounds(accessor, offsets, 3);
        return accessor;
    }

    /// Adds a channel for one property of a node over all frames of a clip.
    void add_channel(OrderedJson& clip_json, std::size_t node, const char* path, std::size_t times, const char* type,
                     std::size_t width, const std::vector<float>& values) {
        clip_json["channels"].push_back(
            {{"sampler", clip_json["samplers"].size()}, {"target", {{"node", node}, {"path", path}}}});
        clip_json["samplers"].push_back(
            {{"input", times}, {"output", add_values(values, k_float, type, width)}, {"interpolation", "LINEAR"}});
    }

    /// Adds a clip. Nodes that stay at rest get no channels, but a clip needs at least one to have a length.
    void add_clip(const Clip& clip) {
        std::vector<float> times;
        for (std::size_t i = 0; i < clip.size(); ++i)
            times.push_back(static_cast<float>(static_cast<double>(i) / clip.frames_per_second));
        const std::size_t input = add_values(times, k_float, "SCALAR", 1);
        add_bounds(input, times, 1);
        OrderedJson json{{"name", clip.name}, {"channels", OrderedJson::array()}, {"samplers", OrderedJson::array()}};
        for (std::size_t node = 0; node < rig_.nodes.size(); ++node) {
            const auto add = [&](const char* path, const char* type, auto member) {
                const std::vector<float> rest = numbers_of(rig_.nodes[node].rest.*member);
                std::vector<float> values;
                bool rests = true;
                for (const Pose& pose : clip.poses) {
                    const std::vector<float> numbers = numbers_of(pose.nodes[node].*member);
                    rests = rests && numbers == rest;
                    values.insert(values.end(), numbers.begin(), numbers.end());
                }
                if (!rests) add_channel(json, node, path, input, type, rest.size(), values);
            };
            add("translation", "VEC3", &NodeTransform::translation);
            add("rotation", "VEC4", &NodeTransform::rotation);
            add("scale", "VEC3", &NodeTransform::scale);
        }
        add_weights(json, clip, input);
        if (json["channels"].empty()) {
            std::vector<float> values;
            for (const Pose& pose : clip.poses)
                values.insert(values.end(), pose.nodes[0].translation.data(), pose.nodes[0].translation.data() + 3);
            add_channel(json, 0, "translation", input, "VEC3", 3, values);
        }
        document_["animations"].push_back(std::move(json));
    }

    void add_weights(OrderedJson& json, const Clip& clip, std::size_t input) {
        if (rig_.targets.empty()) return;
        std::vector<float> values;
        for (const Pose& pose : clip.poses) values.insert(values.end(), pose.weights.begin(), pose.weights.end());
        add_channel(json, mesh_node_, "weights", input, "SCALAR", 1, values);
    }

    const Animation& animation_;
    const Rig& rig_;
    OrderedJson document_;
    std::string binary_;
    std::vector<std::size_t> joints_;
    std::size_t mesh_node_ = 0;
};

void check_writable(const std::filesystem::path& path, const Animation& animation) {
    const auto fail = [&](const std::string& what) { throw MeshError(path.string() + ": " + what); };
    const Rig& rig = animation.rig;
    if (animation.kind == AnimationKind::sequence)
        throw UsageError(path.string() + ": glTF holds no mesh sequences; write a folder of PLY files");
    if (animation.rest.faces.empty() || rig.bones.empty()) fail("glTF cannot hold an animation without faces or bones");
    if (rig.bones.size() > std::numeric_limits<std::uint16_t>::max()) fail("glTF holds at most 65,535 bones");
    const bool finite = std::ranges::all_of(animation.rest.vertices, [](const Vec3& p) { return p.allFinite(); }) &&
                        is_finite(rest_pose(rig)) && std::ranges::all_of(animation.clips, [](const Clip& clip) {
                            return std::ranges::all_of(clip.poses, [](const Pose& pose) { return is_finite(pose); });
                        });
    if (!finite) fail("a vertex or pose is not finite, which glTF cannot say");
    for (const Clip& clip : animation.clips)
        if (clip.poses.empty()) fail(fmt::format("clip '{}' has no frames", clip.name));
}

}  // namespace

void write_gltf_animation(const std::filesystem::path& path, const Animation& animation) {
    check_writable(path, animation);
    const std::string bytes = GltfBuilder(animation).bytes();
    if (bytes.size() > std::numeric_limits<std::uint32_t>::max() / 2)
        throw MeshError(path.string() + ": the animation is too large for a glTF file; write fewer clips");
    write_file_atomically(path, [&](std::ostream& out) { out << bytes; });
}

}  // namespace exemplar
