#include "apps/viewer/controls/pose_controls.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "host/core/errors.h"

namespace exemplar {
namespace {

// A root with an arm of two joints, of which the hand moves vertices, and a lamp that moves none.
Rig arm() {
    Rig rig;
    rig.nodes = {{"root", k_invalid_index, {}}, {"upper", 0, {}}, {"hand", 1, {}}, {"lamp", 0, {}}};
    rig.nodes[2].rest.translation = Vec3(1, 0, 0);
    rig.bones = {{.node = 2}};
    rig.influence_begin = {0, 1};
    rig.influences = {{0, 1.0f}};
    rig.targets = {{.name = "smile", .vertices = {0}, .offsets = {Vec3(0, 1, 0)}, .rest_weight = 0.25f}};
    return rig;
}

TEST(PoseControls, LeaveThePoseAloneUntilTheyAreMoved) {
    const Rig rig = arm();
    const PoseControls controls(rig);
    EXPECT_FALSE(controls.changed());
    const Pose pose = rest_pose(rig), same = controls.apply(pose);
    for (std::size_t i = 0; i < rig.nodes.size(); ++i)
        EXPECT_EQ(same.nodes[i].rotation.coeffs(), pose.nodes[i].rotation.coeffs());
    EXPECT_EQ(same.weights, pose.weights);
}

TEST(PoseControls, TurnAJointAndAllBelowIt) {
    const Rig rig = arm();
    PoseControls controls(rig);
    controls.turns[1] = Vec3(0, 0, 90);
    EXPECT_TRUE(controls.changed());
    const std::vector<Affine> world = node_transforms(rig, controls.apply(rest_pose(rig)));
    EXPECT_LT((world[2].translation() - Vec3(0, 1, 0)).norm(), 1e-6f);
}

TEST(PoseControls, TurnOnFromTheRotationOfThePose) {
    const Rig rig = arm();
    PoseControls controls(rig);
    controls.turns[1] = Vec3(0, 0, 30);
    Pose pose = rest_pose(rig);
    pose.nodes[1].rotation = Eigen::AngleAxisf(std::numbers::pi_v<float> / 3, Vec3::UnitZ());
    const std::vector<Affine> world = node_transforms(rig, controls.apply(pose));
    EXPECT_LT((world[2].translation() - Vec3(0, 1, 0)).norm(), 1e-6f);
}

TEST(PoseControls, AxesTurnInOrder) {
    const Rig rig = arm();
    PoseControls controls(rig);
    controls.turns[1] = Vec3(90, 0, 90);
    const std::vector<Affine> world = node_transforms(rig, controls.apply(rest_pose(rig)));
    EXPECT_LT((world[2].translation() - Vec3(0, 0, 1)).norm(), 1e-6f);  // first about z, as seen from the joint
    EXPECT_NEAR(controls.apply(rest_pose(rig)).nodes[1].rotation.norm(), 1, 1e-6);
}

TEST(PoseControls, AddToBlendWeights) {
    const Rig rig = arm();
    PoseControls controls(rig);
    controls.added_weights[0] = 0.5f;
    EXPECT_THAT(controls.apply(rest_pose(rig)).weights, ::testing::ElementsAre(0.75f));
    controls.reset();
    EXPECT_FALSE(controls.changed());
}

TEST(PoseControls, RefuseAPoseOfAnotherRig) {
    const PoseControls controls(arm());
    EXPECT_THROW(controls.apply(Pose{}), UsageError);
}

TEST(PoseControls, OnlyNodesThatMoveSomethingGetSliders) {
    EXPECT_THAT(moving_nodes(arm()), ::testing::ElementsAre(0u, 1u, 2u));
    EXPECT_TRUE(moving_nodes(Rig{}).empty());
}

}  // namespace
}  // namespace exemplar
