#include "host/animation/animation.h"

#include <fmt/format.h>

#include "host/core/errors.h"

namespace exemplar {

namespace {

Affine matrix_of(const NodeTransform& t) {
    Affine result;
    result.linear() = t.rotation.toRotationMatrix() * t.scale.asDiagonal();
    result.translation() = t.translation;
    return result;
}

}  // namespace

std::string_view name_of(AnimationKind kind) {
    switch (kind) {
        case AnimationKind::skeleton:
            return "skeleton";
        case AnimationKind::blend_shapes:
            return "blend shapes";
        case AnimationKind::sequence:
            break;
    }
    return "mesh sequence";
}

std::size_t Animation::frame_count() const {
    std::size_t count = 0;
    for (const Clip& clip : clips) count += clip.size();
    return count;
}

SurfaceShape shape_at(const Animation& animation, std::size_t clip, std::size_t frame) {
    const bool exists = clip < animation.clips.size() && frame < animation.clips[clip].size();
    if (animation.has_rig()) return {exists ? animation.clips[clip].poses[frame] : rest_pose(animation.rig)};
    return {.pose = {}, .vertices = exists ? animation.clips[clip].frames[frame] : animation.rest.vertices};
}

std::vector<Vec3> vertices_of(const Animation& animation, const SurfaceShape& shape) {
    if (!shape.pose) return {shape.vertices.begin(), shape.vertices.end()};
    std::vector<Vec3> vertices;
    pose_vertices(animation.rig, animation.rest.vertices, *shape.pose, vertices);
    return vertices;
}

Pose rest_pose(const Rig& rig) {
    Pose pose;
    for (const RigNode& node : rig.nodes) pose.nodes.push_back(node.rest);
    for (const MorphTarget& target : rig.targets) pose.weights.push_back(target.rest_weight);
    return pose;
}

std::vector<Affine> node_transforms(const Rig& rig, const Pose& pose) {
    std::vector<Affine> world(rig.nodes.size());
    for (std::size_t i = 0; i < world.size(); ++i) {
        const std::uint32_t parent = rig.nodes[i].parent;
        world[i] = parent == k_invalid_index ? matrix_of(pose.nodes[i]) : world[parent] * matrix_of(pose.nodes[i]);
    }
    return world;
}

std::vector<Affine> bone_transforms(const Rig& rig, const Pose& pose) {
    const std::vector<Affine> world = node_transforms(rig, pose);
    std::vector<Affine> bones;
    bones.reserve(rig.bones.size());
    for (const Bone& bone : rig.bones) bones.push_back(world[bone.node] * bone.inverse_bind);
    return bones;
}

void pose_vertices(const Rig& rig, std::span<const Vec3> rest, const Pose& pose, std::vector<Vec3>& out) {
    morph(rig, rest, pose.weights, out);
    skin_vertices(rig, bone_transforms(rig, pose), out);
}

std::vector<Vec3> frame_vertices(const Animation& animation, const Clip& clip, std::size_t frame) {
    if (frame >= clip.size())
        throw UsageError(fmt::format("clip '{}' has frames 0 to {}, not {}", clip.name, clip.size() - 1, frame));
    if (!clip.frames.empty()) return clip.frames[frame];
    std::vector<Vec3> vertices;
    pose_vertices(animation.rig, animation.rest.vertices, clip.poses[frame], vertices);
    return vertices;
}

}  // namespace exemplar
