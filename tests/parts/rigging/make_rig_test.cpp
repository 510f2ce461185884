#include "host/parts/rigging/make_rig.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <set>

#include "host/animation/read_animation.h"
#include "host/animation/write_animation.h"
#include "host/core/errors.h"
#include "host/parts/rigging/bend_clip.h"
#include "host/parts/rigging/joint_error.h"
#include "tests/parts/rigging/part_shapes.h"
#include "tests/support/shapes.h"
#include "tests/support/temporary_folder.h"

namespace exemplar {
namespace {

const std::vector<std::string> k_arm_names{"upper", "lower", "hand"};

/// An arm along x whose parts meet at 6 and 10; the hand ends at 12.
PartRig arm_rig(const TriangleMesh& mesh) {
    return make_rig(mesh, k_arm_names, part_shapes::labels_along_x(part_shapes::tube(12), {6, 10}));
}

TEST(PartRig, JointsLieAtBoundariesAndBonesAlongParts) {
    const PartRig rig = arm_rig(part_shapes::tube(12));
    const auto& joints = rig.skeleton.joints;
    ASSERT_EQ(joints.size(), 3U);
    EXPECT_EQ(joints[0].name, "upper");
    EXPECT_EQ(joints[1].name, "lower");
    EXPECT_EQ(joints[1].parent, 0U);
    EXPECT_EQ(joints[2].parent, 1U);
    EXPECT_NEAR((joints[1].head - Vec3(6, 0, 0)).norm(), 0, 1e-4);
    EXPECT_NEAR((joints[1].tail - Vec3(10, 0, 0)).norm(), 0, 1e-4);
    EXPECT_NEAR((joints[2].tail - Vec3(12, 0, 0)).norm(), 0, 0.1);
    EXPECT_NEAR(joints[1].axes.col(1).x(), 1, 1e-4) << "y is along the bone";
}

TEST(PartRig, WeightsSumToOneAndStayNearTheirParts) {
    const PartRig rig = arm_rig(part_shapes::tube(12));
    const Rig& skin = rig.animation.rig;
    for (std::size_t v = 0; v < rig.animation.rest.vertex_count(); ++v) {
        const auto row = skin.influences_of(v);
        ASSERT_GE(row.size(), 1U);
        ASSERT_LE(row.size(), 4U);
        float sum = 0;
        for (const Influence& influence : row) {
            EXPECT_GT(influence.weight, 0);
            sum += influence.weight;
            const float x = rig.animation.rest.vertices[v].x();
            if (influence.bone == 2) {
                EXPECT_GE(x, 6) << "the hand moves itself and the lower arm";
            }
            if (influence.bone == 0) {
                EXPECT_LE(x, 10);
            }
        }
        EXPECT_NEAR(sum, 1, 1e-5);
        if (rig.animation.rest.vertices[v].x() == 6) {
            EXPECT_NEAR(row[0].weight, 0.5, 0.05) << "half at the boundary";
        }
        if (rig.animation.rest.vertices[v].x() < 3) {
            EXPECT_EQ(row.size(), 1U);
        }
    }
}

TEST(PartRig, AtRestTheSurfaceStaysAndABendTurnsAboutTheJoint) {
    const PartRig rig = arm_rig(part_shapes::tube(12));
    const TriangleMesh& rest = rig.animation.rest;
    std::vector<Vec3> posed;
    pose_vertices(rig.animation.rig, rest.vertices, rest_pose(rig.animation.rig), posed);
    for (std::size_t v = 0; v < posed.size(); ++v) EXPECT_NEAR((posed[v] - rest.vertices[v]).norm(), 0, 1e-5);
    const Clip clip = clip_of_poses(rig.animation.rig, {{{"lower", Vec3(90, 0, 0)}}}, "test", 1);
    pose_vertices(rig.animation.rig, rest.vertices, clip.poses.back(), posed);
    const std::size_t tip = rest.vertex_count() - 1;  // at (12, 0, 0), six from the elbow
    EXPECT_NEAR((posed[tip] - Vec3(6, 0, 0)).norm(), 6, 1e-4);
    EXPECT_NEAR(posed[tip].x(), 6, 1e-3);
    EXPECT_NEAR((posed[tip - 1] - rest.vertices[tip - 1]).norm(), 0, 1e-5) << "the shoulder rests";
}

TEST(PartRig, TurnsWithTheMesh) {
    TriangleMesh mesh = part_shapes::tube(12), turned = mesh;
    const Eigen::Quaternionf rotation(Eigen::AngleAxisf(1.1F, Vec3(1, 2, -1).normalized()));
    for (Vec3& v : turned.vertices) v = rotation * v + Vec3(3, -2, 1);
    const PartRig a = arm_rig(mesh), b = arm_rig(turned);
    ASSERT_EQ(a.skeleton.joints.size(), b.skeleton.joints.size());
    for (std::size_t j = 0; j < a.skeleton.joints.size(); ++j) {
        const Vec3 expected = rotation * a.skeleton.joints[j].head + Vec3(3, -2, 1);
        EXPECT_NEAR((b.skeleton.joints[j].head - expected).norm(), 0, 1e-3);
    }
    ASSERT_EQ(a.animation.rig.influences.size(), b.animation.rig.influences.size());
    for (std::size_t i = 0; i < a.animation.rig.influences.size(); ++i)
        EXPECT_NEAR(a.animation.rig.influences[i].weight, b.animation.rig.influences[i].weight, 1e-4);
}

/// A body along x with two pairs of legs across z, as components that touch it nearly.
struct Table {
    TriangleMesh mesh = part_shapes::tube(20);
    std::vector<std::int32_t> label = std::vector<std::int32_t>(mesh.face_count(), 0);
    Table() {
        TriangleMesh leg = part_shapes::tube(4);
        for (Vec3& v : leg.vertices) v = Vec3(v.y() / 2, v.z() / 2, v.x());
        TriangleMesh other = leg;
        for (Vec3& v : other.vertices) v.z() = -v.z();
        for (Face& face : other.faces) std::swap(face[0], face[1]);
        for (const float x : {3.0F, 12.0F}) {
            part_shapes::append(mesh, leg, Vec3(x, 0, 1.1F));
            part_shapes::append(mesh, other, Vec3(x, 0, -1.1F));
        }
        label.resize(mesh.face_count(), 1);
    }
};

TEST(PartRig, PairsAreLeftAndRightAndRowsAreNumbered) {
    const Table table;
    const PartRig rig = make_rig(table.mesh, {"body", "leg"}, table.label);
    std::map<std::string, Vec3> heads;
    for (const Joint& joint : rig.skeleton.joints) heads[joint.name] = joint.head;
    ASSERT_TRUE(rig.mirror);
    EXPECT_NEAR(std::abs(rig.mirror->normal.z()), 1, 0.02);
    ASSERT_EQ(heads.size(), 5U);
    for (const char* name : {"leg_left_1", "leg_left_2", "leg_right_1", "leg_right_2"})
        ASSERT_TRUE(heads.contains(name)) << name;
    EXPECT_GT(heads["leg_left_1"].z(), 0);
    EXPECT_LT(heads["leg_right_1"].z(), 0);
    EXPECT_NEAR(heads["leg_left_1"].x(), heads["leg_right_1"].x(), 0.1);
    RigOptions swapped;
    swapped.swap_sides = true;
    swapped.root = "leg";
    const PartRig other = make_rig(table.mesh, {"body", "leg"}, table.label, swapped);
    EXPECT_NE(other.skeleton.joints[0].name, "body");
    EXPECT_THROW(make_rig(table.mesh, {"body", "leg"}, table.label, {"tail"}), DataError);
}

TEST(PartRig, ComesBackFromAFile) {
    const TemporaryFolder folder;
    PartRig rig = arm_rig(part_shapes::tube(12));
    rig.animation.clips.push_back(bend_each_joint(rig.animation.rig, 30, 4));
    write_gltf_animation(folder.path() / "arm.glb", rig.animation);
    const Animation read = read_animation(folder.path() / "arm.glb");
    ASSERT_EQ(read.clips.size(), 1U);
    EXPECT_EQ(read.kind, AnimationKind::skeleton);
    EXPECT_EQ(read.clips[0].size(), rig.animation.clips[0].size());
    EXPECT_EQ(read.rest.face_count(), rig.animation.rest.face_count());
}

TEST(BendClip, BendsEachJointInTurnAndNoFartherThanAsked) {
    const PartRig rig = arm_rig(part_shapes::tube(12));
    const Clip clip = bend_each_joint(rig.animation.rig, 30, 8);
    EXPECT_EQ(clip.size(), 1U + 2 * 2 * 8);
    float most = 0;
    for (const Pose& pose : clip.poses) {
        std::size_t moved = 0;
        for (std::size_t n = 0; n < pose.nodes.size(); ++n) {
            const float angle = pose.nodes[n].rotation.angularDistance(rig.animation.rig.nodes[n].rest.rotation);
            moved += angle > 1e-3F;
            most = std::max(most, angle);
        }
        EXPECT_LE(moved, 1U);
    }
    EXPECT_NEAR(most, 30 * std::numbers::pi / 180, 1e-3);
}

TEST(BendClip, RefusesWhatIsNoPose) {
    const TemporaryFolder folder;
    const PartRig rig = arm_rig(part_shapes::tube(12));
    for (const char* text :
         {"", "3", "{}", "[]", R"({"hand": [1, 2]})", R"({"hand": [1, 2, "x"]})", R"([{"hand": 1}])"}) {
        std::ofstream(folder.path() / "pose.json") << text;
        EXPECT_THROW(read_poses(folder.path() / "pose.json"), DataError) << text;
    }
    EXPECT_THROW(clip_of_poses(rig.animation.rig, {{{"hnad", Vec3::Zero()}}}, "x"), DataError);
}

// Four parts around a ring: where the ring is cut decides which part hangs on which.
TEST(MakeSkeleton, CutsARingBetweenLabelsThatRarelyTouch) {
    const TriangleMesh ring = shapes::torus(3, 1, 32, 12);
    const std::vector<std::string> names{"torso", "arm", "hand", "leg"};
    std::vector<std::int32_t> label;
    for (const Vec3& center : face_centers(ring))
        label.push_back(center.y() > 0 ? (center.x() > 0 ? 0 : 1) : (center.x() > 0 ? 3 : 2));
    for (const auto& rare : std::vector<std::pair<std::string, std::string>>{{"hand", "leg"}, {"arm", "hand"}}) {
        const PartRig rig = make_skeleton(ring, names, label, {.root = "torso", .costs = {{rare, 100}}});
        ASSERT_EQ(rig.skeleton.joints.size(), 4U);
        for (const Joint& joint : rig.skeleton.joints) {
            if (joint.parent == k_invalid_index) continue;
            const auto name = [&](std::uint32_t part) {
                return names[static_cast<std::size_t>(rig.graph.parts[part].label)];
            };
            const std::string own = name(joint.part), above = name(rig.skeleton.joints[joint.parent].part);
            EXPECT_FALSE(std::min(own, above) == rare.first && std::max(own, above) == rare.second) << own;
        }
    }
}

TEST(JointErrors, MeasuresTheDistanceOfJointsBetweenTheSameLabels) {
    const TriangleMesh mesh = part_shapes::tube(12);
    const PartRig truth = make_skeleton(mesh, k_arm_names, part_shapes::labels_along_x(mesh, {6, 10}));
    const PartRig found = make_skeleton(mesh, k_arm_names, part_shapes::labels_along_x(mesh, {6.5F}));
    const auto errors =
        joint_errors({truth.skeleton, truth.graph, k_arm_names}, {found.skeleton, found.graph, k_arm_names});
    ASSERT_EQ(errors.size(), 2U);
    ASSERT_TRUE(errors[0].distance);
    EXPECT_NEAR(*errors[0].distance, 0.5, 1e-3);
    EXPECT_FALSE(errors[1].distance) << "no hand was found";
}

}  // namespace
}  // namespace exemplar
