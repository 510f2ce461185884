#include "gpu/curvature/surface/poser.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "embedded/curvature_pose_comp.h"
#include "gpu/curvature/surface/texels.h"
#include "host/core/errors.h"
#include "shaders/shared/curvature.h"

namespace exemplar {
namespace {

using shared::InfluencePair;
using shared::k_last_of_vertex;
using shared::MorphOffset;
using shared::PoseParameters;
using shared::RestVertex;
using shared::uvec4;
using shared::vec4;

// The kernel fetches each as one four-component vector.
static_assert(sizeof(RestVertex) == 16 && sizeof(InfluencePair) == 16 && sizeof(MorphOffset) == 16);

constexpr std::size_t k_rows_per_bone = 3;

[[noreturn]] void refuse_rig(const std::string& what) {
    throw UsageError("a rig cannot be posed: " + what);
}

void check_influences(const Rig& rig, std::size_t vertices) {
    const std::vector<std::uint32_t>& begin = rig.influence_begin;
    if (begin.size() != vertices + 1 || begin.front() != 0 || begin.back() != rig.influences.size())
        refuse_rig(
            fmt::format("its influences are not those of {} vertices; read or build it for this mesh", vertices));
    for (std::size_t v = 0; v < vertices; ++v)
        if (begin[v + 1] <= begin[v]) refuse_rig(fmt::format("vertex {} has no influence; bind it to a bone", v));
    for (const Influence& influence : rig.influences)
        if (influence.bone >= rig.bones.size())
            refuse_rig(fmt::format("an influence is of bone {}, but there are {}", influence.bone, rig.bones.size()));
}

void check_targets(const Rig& rig, std::size_t vertices) {
    for (const MorphTarget& target : rig.targets) {
        if (target.vertices.size() != target.offsets.size())
            refuse_rig(fmt::format("target '{}' has {} vertices and {} offsets", target.name, target.vertices.size(),
                                   target.offsets.size()));
        for (const std::uint32_t v : target.vertices)
            if (v >= vertices)
                refuse_rig(fmt::format("target '{}' moves vertex {}, but there are {}", target.name, v, vertices));
    }
}

void check_skeleton(const Rig& rig) {
    for (std::size_t i = 0; i < rig.nodes.size(); ++i)
        if (rig.nodes[i].parent != k_invalid_index && rig.nodes[i].parent >= i)
            refuse_rig(fmt::format("node {} comes before its parent {}", i, rig.nodes[i].parent));
    for (const Bone& bone : rig.bones)
        if (bone.node >= rig.nodes.size())
            refuse_rig(fmt::format("a bone is of node {}, but there are {}", bone.node, rig.nodes.size()));
}

// Appends the pairs of one vertex.
void append_pairs(std::span<const Influence> influences, std::vector<InfluencePair>& pairs) {
    for (std::size_t i = 0; i < influences.size(); i += 2) {
        const Influence second = i + 1 < influences.size() ? influences[i + 1] : Influence{influences[i].bone, 0.0f};
        pairs.push_back({influences[i].bone, influences[i].weight, second.bone, second.weight});
    }
    pairs.back().first_bone |= k_last_of_vertex;
}

// The offsets of all targets, by vertex and then by target.
struct Morphs {
    std::vector<std::uint32_t> begin;  // per vertex; 0 where no target moves it
    std::vector<MorphOffset> offsets;  // the first is unused
};

Morphs gather_morphs(const Rig& rig, std::size_t vertices) {
    std::vector<std::uint32_t> count(vertices, 0);
    for (const MorphTarget& target : rig.targets)
        for (const std::uint32_t v : target.vertices) ++count[v];
    Morphs morphs{.begin = std::vector<std::uint32_t>(vertices, 0), .offsets = {}};
    std::uint32_t end = 1;
    for (std::size_t v = 0; v < vertices; ++v) {
        if (count[v] != 0) morphs.begin[v] = end;
        end += count[v];
    }
    morphs.offsets.resize(end, MorphOffset{});
    std::vector<std::uint32_t> next = morphs.begin;
    for (std::uint32_t t = 0; t < rig.targets.size(); ++t)
        for (std::size_t i = 0; i < rig.targets[t].vertices.size(); ++i) {
            const std::uint32_t v = rig.targets[t].vertices[i];
            const Vec3& offset = rig.targets[t].offsets[i];
            const std::uint32_t mark = --count[v] == 0 ? k_last_of_vertex : 0;
            morphs.offsets[next[v]++] = {offset.x(), offset.y(), offset.z(), t | mark};
        }
    return morphs;
}

void write_vertices(std::span<const Vec3> vertices, std::span<std::byte> memory) {
    auto* out = reinterpret_cast<vec4*>(memory.data());
    for (const Vec3& v : vertices) *out++ = {v.x(), v.y(), v.z(), 1.0f};
}

void write_pose(std::span<const Affine> bones, std::span<const float> weights, std::span<std::byte> memory) {
    auto* rows = reinterpret_cast<vec4*>(memory.data());
    for (const Affine& bone : bones)
        for (Eigen::Index i = 0; i < static_cast<Eigen::Index>(k_rows_per_bone); ++i)
            *rows++ = {bone(i, 0), bone(i, 1), bone(i, 2), bone(i, 3)};
    std::ranges::copy(weights, reinterpret_cast<float*>(rows));
}

}  // namespace

GpuPoser::GpuPoser(Device& device, const Rig& rig, std::span<const Vec3> rest)
    : vertex_count_(rest.size()),
      target_count_(rig.targets.size()),
      kernel_(device, shaders::curvature_pose_comp,
              {.push_constants = layout_of<PoseParameters>(),
               .elements = {layout_of<uvec4>(), layout_of<uvec4>(), layout_of<std::uint32_t>(), layout_of<uvec4>(),
                            layout_of<vec4>(), layout_of<float>(), layout_of<vec4>()}}),
      vertices_(device, rest.size() * sizeof(vec4)) {
    std::vector<vec4> start(rest.size());
    write_vertices(rest, std::as_writable_bytes(std::span(start)));
    vertices_.upload<vec4>(start);
    if (!rig.bones.empty()) upload_rig(device, rig, rest);
}

void GpuPoser::upload_rig(Device& device, const Rig& rig, std::span<const Vec3> rest) {
    check_skeleton(rig);
    check_influences(rig, rest.size());
    check_targets(rig, rest.size());
    skeleton_.nodes = rig.nodes;
    skeleton_.bones = rig.bones;
    std::vector<RestVertex> vertices;
    std::vector<InfluencePair> pairs;
    for (std::size_t v = 0; v < rest.size(); ++v) {
        vertices.push_back({rest[v].x(), rest[v].y(), rest[v].z(), static_cast<std::uint32_t>(pairs.size())});
        append_pairs(rig.influences_of(v), pairs);
    }
    check_texels(device, pairs.size(), "the influences of a rig");
    rest_ = Buffer::of<RestVertex>(device, vertices);
    influences_ = Buffer::of<InfluencePair>(device, pairs);
    const Morphs morphs = gather_morphs(rig, target_count_ == 0 ? 0 : rest.size());
    check_texels(device, morphs.offsets.size(), "the morph targets of a rig");
    morph_begin_ = Buffer::of<std::uint32_t>(device, morphs.begin);
    morphs_ = Buffer::of<MorphOffset>(device, morphs.offsets);
    pose_ = Buffer(device, k_rows_per_bone * sizeof(vec4) * rig.bones.size() + sizeof(float) * target_count_);
}

void GpuPoser::record(Stream& stream, const Pose& pose) {
    if (skeleton_.bones.empty()) throw UsageError("a rig without bones cannot be posed; set its vertices");
    if (pose.nodes.size() != skeleton_.nodes.size() || pose.weights.size() != target_count_)
        throw UsageError(fmt::format("a pose of {} nodes and {} weights is not of a rig of {} nodes and {} targets",
                                     pose.nodes.size(), pose.weights.size(), skeleton_.nodes.size(), target_count_));
    const std::vector<Affine> bones = bone_transforms(skeleton_, pose);
    stream.upload_with(pose_, pose_.bytes(), 0,
                       [&](std::span<std::byte> memory) { write_pose(bones, pose.weights, memory); });
    const std::size_t floats = k_rows_per_bone * 4 * bones.size();
    stream.dispatch(
        kernel_, vertex_count_,
        {rest_, influences_, morph_begin_, morphs_, BufferRange(pose_, 0, floats * sizeof(float)), pose_, vertices_},
        PoseParameters{.vertices = static_cast<std::uint32_t>(vertex_count_),
                       .first_weight = static_cast<std::uint32_t>(floats),
                       .targets = static_cast<std::uint32_t>(target_count_)});
}

void GpuPoser::set_vertices(Stream& stream, std::span<const Vec3> vertices) {
    if (vertices.size() != vertex_count_)
        throw UsageError(
            fmt::format("a frame of {} vertices is not of a surface of {}", vertices.size(), vertex_count_));
    stream.upload_with(vertices_, vertices_.bytes(), 0,
                       [&](std::span<std::byte> memory) { write_vertices(vertices, memory); });
}

}  // namespace exemplar
