#include "host/synth/animations/figure.h"

#include <algorithm>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "host/synth/animations/skin_weights.h"
#include "host/synth/modeling/fairing.h"
#include "host/synth/modeling/surface.h"

namespace exemplar {
namespace {

constexpr double k_figure_fairing = 0.07;  // width of the bumps to smooth: those where solids meet, not the nose

Rig skeleton_of(const FigureModel& model) {
    Rig rig;
    for (std::size_t j = 0; j < k_figure_joints; ++j) {
        const FigureJoint& joint = figure_joints()[j];
        const Vec3 base = joint.parent == k_invalid_index ? Vec3(Vec3::Zero()) : model.joint[joint.parent];
        RigNode node{std::string(joint.name), joint.parent, {}};
        node.rest.translation = model.joint[j] - base;
        rig.nodes.push_back(std::move(node));
        Bone bone{static_cast<std::uint32_t>(j), Affine::Identity()};
        bone.inverse_bind.translation() = -model.joint[j];
        rig.bones.push_back(bone);
    }
    return rig;
}

/// Returns the joint that moves each vertex most: that of the nearest solid, or, in the trunk, which is one mass, by
/// height.
std::vector<std::uint32_t> nearest_joints(const TriangleMesh& mesh, const FigureModel& model,
                                          const ImplicitField& field) {
    constexpr std::uint32_t k_trunk = 3;  // hips, spine, chest
    std::vector<std::uint32_t> joints;
    for (const Vec3& v : mesh.vertices) {
        auto joint = static_cast<std::uint32_t>(field.dominant_part(v));
        if (joint < k_trunk) joint = v.y() < model.joint[1].y() ? 0 : v.y() < model.joint[2].y() ? 1 : 2;
        joints.push_back(joint);
    }
    return joints;
}

}  // namespace

Animation make_figure(const AnimationOptions& options) {
    Random random(Random(options.shape_seed).fork(1));
    const FigureModel model = sculpt_figure(random);
    const ImplicitField field(model.shape.primitives);
    Animation animation;
    animation.kind = AnimationKind::skeleton;
    animation.rest = mesh_surface(field, model.shape.detail, options.vertices);
    const std::vector<std::uint32_t> joints = nearest_joints(animation.rest, model, field);
    fair(animation.rest, k_figure_fairing);
    animation.rig = skeleton_of(model);
    std::vector<BoneSegment> segments;
    for (std::size_t j = 0; j < k_figure_joints; ++j) segments.push_back({model.joint[j], model.tip[j]});
    set_skin_weights(animation.rig, animation.rest, segments, joints);
    animation.clips.push_back(move_figure(model, animation.rig, options.frames, Random(options.motion_seed).fork(2)));
    return animation;
}

}  // namespace exemplar
