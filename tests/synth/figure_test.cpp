#include "host/synth/animations/figure.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <vector>

#include "host/mesh/topology.h"

namespace exemplar {
namespace {

const Animation& figure() {
    static const Animation animation = make_animation("figure", {3000, 120, 1, 1});
    return animation;
}

const FigureModel& model() {
    static const FigureModel sculpted = [] {
        Random random(3);
        return sculpt_figure(random);
    }();
    return sculpted;
}

std::size_t joint_named(std::string_view name) {
    for (std::size_t j = 0; j < k_figure_joints; ++j)
        if (figure_joints()[j].name == name) return j;
    throw std::out_of_range("no such joint");
}

float weight_of(const Rig& rig, std::size_t vertex, std::size_t bone) {
    for (const Influence& influence : rig.influences_of(vertex))
        if (influence.bone == bone) return influence.weight;
    return 0;
}

TEST(Figure, RestPoseIsTheBindSpace) {
    std::vector<Vec3> posed;
    pose_vertices(figure().rig, figure().rest.vertices, rest_pose(figure().rig), posed);
    for (std::size_t v = 0; v < posed.size(); ++v) EXPECT_LT((posed[v] - figure().rest.vertices[v]).norm(), 1e-5f);
}

TEST(Figure, HasAtMostFourInfluencesThatSumToOneByRisingBone) {
    const Rig& rig = figure().rig;
    ASSERT_EQ(rig.influence_begin.size(), figure().rest.vertex_count() + 1);
    for (std::size_t v = 0; v < figure().rest.vertex_count(); ++v) {
        const auto influences = rig.influences_of(v);
        ASSERT_GE(influences.size(), 1u);
        ASSERT_LE(influences.size(), 4u);
        float sum = 0;
        for (std::size_t i = 0; i < influences.size(); ++i) {
            sum += influences[i].weight;
            EXPECT_GT(influences[i].weight, 0);
            EXPECT_TRUE(i == 0 || influences[i].bone > influences[i - 1].bone);
        }
        EXPECT_NEAR(sum, 1, 1e-5);
    }
}

TEST(Figure, WeightsVarySmoothlyOverTheSurface) {
    const Topology topology = build_topology(figure().rest);
    for (const Edge& edge : topology.edges) {
        const auto [a, b] = edge.vertex;
        const float length = (figure().rest.vertices[a] - figure().rest.vertices[b]).norm();
        for (std::size_t j = 0; j < k_figure_joints; ++j) {
            const float change = std::abs(weight_of(figure().rig, a, j) - weight_of(figure().rig, b, j));
            EXPECT_LT(change, 40 * length) << figure_joints()[j].name;  // from 0 to 1 over 2.5 cm at the least
        }
    }
}

TEST(Figure, BonesPullOnlyWhatIsNearThem) {
    const Rig& rig = figure().rig;
    for (std::size_t v = 0; v < figure().rest.vertex_count(); ++v) {
        const Vec3& p = figure().rest.vertices[v];
        if (p.x() < -0.02f) {
            for (const auto* name : {"left_shoulder", "left_elbow", "left_wrist", "left_knee", "left_ankle"})
                EXPECT_EQ(weight_of(rig, v, joint_named(name)), 0) << name << " at " << p.transpose();
        }
        EXPECT_TRUE(p.y() < 1.3f || weight_of(rig, v, joint_named("left_hip")) == 0) << p.transpose();
        EXPECT_TRUE(p.y() > 0.6f || weight_of(rig, v, joint_named("chest")) == 0) << p.transpose();
    }
}

TEST(Figure, EveryBoneLeadsSomeVertices) {
    for (std::size_t j = 0; j < k_figure_joints; ++j) {
        float largest = 0;
        for (std::size_t v = 0; v < figure().rest.vertex_count(); ++v)
            largest = std::max(largest, weight_of(figure().rig, v, j));
        EXPECT_GT(largest, 0.6f) << figure_joints()[j].name;
    }
}

TEST(Figure, JointAnglesAreThoseTheRotationWasMadeOf) {
    Random random(5);
    for (std::size_t j = 0; j < k_figure_joints; ++j) {
        const FigureJoint& joint = figure_joints()[j];
        const Eigen::Matrix3f axes = figure_axes(model(), j);
        EXPECT_NEAR(axes.determinant(), 1, 1e-5);
        for (int trial = 0; trial < 20; ++trial) {
            const std::array<float, 3> angles{pick(random, -85, 85), pick(random, -170, 170), pick(random, -170, 170)};
            const std::array<float, 3> found = joint_angles(joint, axes, joint_rotation(joint, axes, angles));
            for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(found[i], angles[i], 0.05) << joint.name << " " << i;
        }
    }
}

TEST(Figure, RightLimbsMirrorLeftOnes) {
    for (std::size_t j = 0; j < k_figure_joints; ++j) {
        if (figure_joints()[j].side <= 0) continue;
        const std::size_t k = j + 7;
        EXPECT_EQ(figure_joints()[k].name.substr(5), figure_joints()[j].name.substr(4));
        const std::array<float, 3> angles{20, 30, 40};
        const Eigen::Matrix3f mirror = Vec3(-1, 1, 1).asDiagonal();
        const Eigen::Matrix3f left =
            joint_rotation(figure_joints()[j], figure_axes(model(), j), angles).toRotationMatrix();
        const Eigen::Matrix3f right =
            joint_rotation(figure_joints()[k], figure_axes(model(), k), angles).toRotationMatrix();
        EXPECT_LT((mirror * left * mirror - right).norm(), 1e-5f) << figure_joints()[j].name;
    }
}

TEST(Figure, JointsStayWithinTheirLimitsAndMove) {
    // The axes depend on the shape only through the directions of its bones, which the rig has too.
    Random random(Random(1).fork(1));
    const FigureModel own = sculpt_figure(random);
    for (std::size_t j = 0; j < k_figure_joints; ++j) {
        const FigureJoint& joint = figure_joints()[j];
        for (std::size_t i = 0; i < 3; ++i) {
            float low = 1e9f, high = -1e9f;
            for (const Pose& pose : figure().clips.front().poses) {
                const float angle = joint_angles(joint, figure_axes(own, j), pose.nodes[j].rotation)[i];
                low = std::min(low, angle);
                high = std::max(high, angle);
            }
            // A bend beyond 90 degrees reads as a turned twist and side: those of elbows and knees are checked below.
            if (std::max(joint.limits.high[0], -joint.limits.low[0]) > 90) continue;
            EXPECT_GE(low, joint.limits.low[i] - 0.1f) << joint.name << " " << i;
            EXPECT_LE(high, joint.limits.high[i] + 0.1f) << joint.name << " " << i;
            EXPECT_GE(high - low, 0.2f * (joint.limits.high[i] - joint.limits.low[i])) << joint.name << " " << i;
        }
    }
}

TEST(Figure, ElbowsBendForwardOnlyAndKneesBackwardOnly) {
    const Rig& rig = figure().rig;
    const auto bend = [&](const Pose& pose, std::string_view joint, std::string_view next) {
        const Vec3 along = rig.nodes[joint_named(next)].rest.translation.normalized();
        const Vec3 turned = pose.nodes[joint_named(joint)].rotation * along;
        return std::atan2(turned.z(), turned.dot(along)) * 57.29578f;
    };
    for (const Pose& pose : figure().clips.front().poses) {
        for (const std::string side : {"left_", "right_"}) {
            const float elbow = bend(pose, side + "elbow", side + "wrist");
            const float knee = bend(pose, side + "knee", side + "ankle");
            EXPECT_GE(elbow, -0.1f);
            EXPECT_LE(elbow, 126);
            EXPECT_LE(knee, 0.1f);
            EXPECT_GE(knee, -121);
        }
    }
}

TEST(Figure, MovesSmoothlyFromFrameToFrame) {
    const Clip& clip = figure().clips.front();
    for (std::size_t f = 2; f < clip.size(); ++f) {
        for (std::size_t j = 0; j < k_figure_joints; ++j) {
            const auto step = [&](std::size_t g) {
                return clip.poses[g - 1].nodes[j].rotation.conjugate() * clip.poses[g].nodes[j].rotation;
            };
            const float turn = step(f).angularDistance(Eigen::Quaternionf::Identity()) * 57.29578f;
            const float jerk = step(f).angularDistance(step(f - 1)) * 57.29578f;
            EXPECT_LT(turn, 16) << figure_joints()[j].name << " frame " << f;  // 480 degrees per second
            EXPECT_LT(jerk, 4) << figure_joints()[j].name << " frame " << f;
        }
    }
}

TEST(Figure, PosedSurfaceIsFiniteAndStretchesWithinBounds) {
    const TriangleMesh& rest = figure().rest;
    const Topology topology = build_topology(rest);
    for (std::size_t f = 0; f < figure().clips.front().size(); f += 5) {
        const std::vector<Vec3> posed = frame_vertices(figure(), figure().clips.front(), f);
        float largest = 0;
        for (const Edge& edge : topology.edges) {
            const auto [a, b] = edge.vertex;
            largest = std::max(largest, (posed[a] - posed[b]).norm() / (rest.vertices[a] - rest.vertices[b]).norm());
        }
        EXPECT_LT(largest, 3.5f) << "frame " << f;  // where a knee or elbow is bent
        for (const Vec3& p : posed) ASSERT_TRUE(p.allFinite());
    }
}

}  // namespace
}  // namespace exemplar
