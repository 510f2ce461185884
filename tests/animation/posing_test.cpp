#include <gtest/gtest.h>

#include <numbers>

#include "host/animation/animation.h"
#include "host/core/errors.h"

namespace exemplar {
namespace {

/// Two bones along x, the second at (1, 0, 0); vertices at 0, 1 and 2, the middle one bound to both.
Rig posed_arm() {
    Rig rig;
    rig.nodes = {{"upper", k_invalid_index, {}}, {"lower", 0, {.translation = Vec3(1, 0, 0)}}};
    Affine inverse = Affine::Identity();
    inverse.translation() = Vec3(-1, 0, 0);
    rig.bones = {{0, Affine::Identity()}, {1, inverse}};
    rig.influence_begin = {0, 1, 3, 4};
    rig.influences = {{0, 1.0f}, {0, 0.5f}, {1, 0.5f}, {1, 1.0f}};
    return rig;
}
const std::vector<Vec3> k_line = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};

TEST(Posing, TheRestPoseOfAnArmIsItsRestMesh) {
    const Rig rig = posed_arm();
    std::vector<Vec3> posed;
    pose_vertices(rig, k_line, rest_pose(rig), posed);
    for (std::size_t v = 0; v < 3; ++v) EXPECT_NEAR((posed[v] - k_line[v]).norm(), 0, 1e-6);
}

TEST(Posing, AJointTurnsWhatHangsOnIt) {
    const Rig rig = posed_arm();
    Pose pose = rest_pose(rig);
    pose.nodes[1].rotation = Eigen::AngleAxisf(std::numbers::pi_v<float> / 2, Vec3::UnitZ());
    std::vector<Vec3> posed;
    pose_vertices(rig, k_line, pose, posed);
    EXPECT_NEAR((posed[0] - Vec3(0, 0, 0)).norm(), 0, 1e-6);
    EXPECT_NEAR((posed[1] - Vec3(1, 0, 0)).norm(), 0, 1e-6);
    EXPECT_NEAR((posed[2] - Vec3(1, 1, 0)).norm(), 0, 1e-6);
    pose.nodes[0].translation = Vec3(0, 0, 5);
    pose_vertices(rig, k_line, pose, posed);
    EXPECT_NEAR((posed[2] - Vec3(1, 1, 5)).norm(), 0, 1e-6);
}

TEST(Posing, TargetsAddBeforeBonesMove) {
    Rig rig = posed_arm();
    rig.targets = {{"bulge", {2}, {Vec3(0, 1, 0)}, 0.0f}};
    Pose pose = rest_pose(rig);
    pose.weights[0] = 0.5f;
    pose.nodes[1].rotation = Eigen::AngleAxisf(std::numbers::pi_v<float> / 2, Vec3::UnitZ());
    std::vector<Vec3> posed;
    pose_vertices(rig, k_line, pose, posed);
    EXPECT_NEAR((posed[2] - Vec3(0.5f, 1, 0)).norm(), 0, 1e-6);
}

TEST(Posing, AFrameThatIsNotThereIsRefused) {
    Animation animation;
    animation.name = "a";
    animation.kind = AnimationKind::sequence;
    animation.clips.resize(1);
    animation.clips[0].name = "walk";
    animation.clips[0].frames = {k_line};
    EXPECT_EQ(frame_vertices(animation, animation.clips[0], 0), k_line);
    EXPECT_THROW(frame_vertices(animation, animation.clips[0], 1), UsageError);
}

}  // namespace
}  // namespace exemplar
