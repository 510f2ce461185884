#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "host/curvature/learning/influence.h"
#include "host/curvature/state/segments.h"
#include "host/curvature/state/state.h"
#include "tests/support/bending_tube.h"
#include "tests/support/shapes.h"

namespace exemplar {
namespace {

std::vector<const Pose*> pointers(const Clip& clip) {
    std::vector<const Pose*> poses;
    for (const Pose& pose : clip.poses) poses.push_back(&pose);
    return poses;
}

TEST(State, OfAHingeIsItsAngleWithTheSignOfTheBend) {
    // Two triangles over the x axis, the second raised by an angle; convex seen from above where it points down.
    const Hinge hinge{0, 1, 2, 3};
    for (const float angle : {-1.2f, -0.1f, 0.0f, 0.4f, 2.5f}) {
        const std::vector<Vec3> vertices = {
            {0, 0, 0}, {1, 0, 0}, {0.3f, 1, 0}, {0.6f, -std::cos(angle), -std::sin(angle)}};
        EXPECT_NEAR(bend(hinge, vertices), angle, 1e-5);
    }
}

TEST(State, OfASkeletonHasTheJointsThatTurn) {
    const Animation tube = shapes::bending_tube();
    const StateReader reader = make_rig_state(tube, pointers(tube.clips[0]));
    ASSERT_EQ(reader.controls.size(), 2u);  // the root turns with the whole; the upper arm hangs still on it
    EXPECT_EQ(reader.controls[0].name, "root");
    EXPECT_EQ(reader.controls[1].name, "elbow");
    EXPECT_EQ(reader.input_count, 6u);
}

TEST(State, OfAJointIsTheSineOfHalfItsAngleAgainstTheMean) {
    Animation tube = shapes::tube_rig();
    Clip clip;
    const float step = std::numbers::pi_v<float> / 6;
    for (const float angle : {0.0f, step, 2 * step}) {
        Pose pose = rest_pose(tube.rig);
        pose.nodes[2].rotation = Eigen::AngleAxisf(angle, Vec3::UnitZ());
        if (angle > step) pose.nodes[2].rotation.coeffs() *= -1;  // the same rotation
        clip.poses.push_back(pose);
    }
    const StateReader reader = make_rig_state(tube, pointers(clip));
    ASSERT_EQ(reader.controls.size(), 1u);
    for (int i = 0; i < 3; ++i) {
        std::array<float, 3> x{};
        reader.read_pose(clip.poses[static_cast<std::size_t>(i)], x);
        EXPECT_NEAR(x[2], std::sin(float(i - 1) * step / 2), 1e-5);
        EXPECT_NEAR(x[0], 0, 1e-5);
    }
}

TEST(State, OfASequenceDoesNotChangeWhenItMovesAsAWhole) {
    const TriangleMesh rest = shapes::grid(8, 8, 1);
    std::vector<std::vector<Vec3>> frames;
    for (int i = 0; i < 12; ++i) {
        frames.push_back(rest.vertices);
        for (Vec3& p : frames.back()) p.z() = std::sin(0.5f * float(i) + 4 * p.x()) * 0.2f * std::cos(float(i) * p.y());
    }
    const StateReader reader = make_sequence_state(rest, frames, {.patch_vertices = 41});
    ASSERT_EQ(reader.controls.size(), 2u);
    ASSERT_GT(reader.input_count, 2u);
    std::vector<float> before(reader.input_count), after(reader.input_count);
    reader.read_surface(frames[5], {}, {}, before);
    const Eigen::AngleAxisf turn(2, Vec3(1, 1, 0).normalized());
    for (Vec3& p : frames[5]) p = turn * p + Vec3(3, 2, 1);
    reader.read_surface(frames[5], {}, {}, after);
    for (std::size_t i = 0; i < before.size(); ++i) EXPECT_NEAR(after[i], before[i], 1e-3);
}

TEST(State, FarPosesAreFartherThanTraining) {
    const Animation tube = shapes::bending_tube(40);
    const StateReader reader = make_rig_state(tube, pointers(tube.clips[0]));
    Eigen::MatrixXf states(Eigen::Index(tube.clips[0].size()), Eigen::Index(reader.input_count));
    std::vector<float> x(reader.input_count);
    for (std::size_t i = 0; i < tube.clips[0].size(); ++i) {
        reader.read_pose(tube.clips[0].poses[i], x);
        states.row(Eigen::Index(i)) = Eigen::Map<Eigen::RowVectorXf>(x.data(), Eigen::Index(x.size()));
    }
    const PoseRange range = make_pose_range(reader, states);
    for (Eigen::Index i = 0; i < states.rows(); ++i) {
        Eigen::VectorXf row = states.row(i);
        EXPECT_LE(range.farthest(reader, {row.data(), reader.input_count}).distance, 1.001f);
    }
    Pose far = tube.clips[0].poses[0];
    far.nodes[2].rotation = Eigen::AngleAxisf(2.5f, Vec3::UnitX());
    reader.read_pose(far, x);
    EXPECT_GT(range.farthest(reader, x).distance, 1.5f);
    EXPECT_EQ(reader.controls[range.farthest(reader, x).control].name, "elbow");
}

TEST(Segments, OfATubeAreItsBonesAndTurnWithThem) {
    const Animation tube = shapes::bending_tube();
    const Segments segments = segment_rig(tube.rig, tube.rest.vertex_count());
    ASSERT_GE(segments.count(), 2u);
    EXPECT_NE(segments.segment_of_vertex.front(), segments.segment_of_vertex.back());
    const Pose& pose = tube.clips[0].poses[3];
    std::vector<Eigen::Matrix3f> rotations;
    segments.rotations_of_rig(bone_transforms(tube.rig, pose), rotations);
    const Eigen::Matrix3f upper(pose.nodes[0].rotation), lower = upper * pose.nodes[2].rotation.toRotationMatrix();
    EXPECT_NEAR((rotations[segments.segment_of_vertex.front()] - upper).norm(), 0, 0.05);
    EXPECT_NEAR((rotations[segments.segment_of_vertex.back()] - lower).norm(), 0, 0.05);
}

TEST(Segments, OfASequenceTurnWithItsParts) {
    const Animation tube = shapes::bending_tube(80);
    std::vector<std::vector<Vec3>> frames;
    for (std::size_t i = 0; i < 30; ++i) frames.push_back(frame_vertices(tube, tube.clips[0], i));
    const Segments segments = segment_sequence(tube.rest, frames);
    ASSERT_GE(segments.count(), 2u);
    std::vector<Eigen::Matrix3f> rotations;
    const std::uint32_t front = segments.segment_of_vertex.front();
    segments.rotations_of_sequence(tube.rest.vertices, rotations);
    const Eigen::Matrix3f at_rest = rotations[front];
    EXPECT_NEAR((at_rest * at_rest.transpose() - Eigen::Matrix3f::Identity()).norm(), 0, 1e-5);
    segments.rotations_of_sequence(frames[3], rotations);
    const Eigen::Matrix3f upper(tube.clips[0].poses[3].nodes[0].rotation);
    EXPECT_NEAR((rotations[front] - upper * at_rest).norm(), 0, 0.05);
}

TEST(Segments, ARotationIsFoundInWhatHoldsOne) {
    const Eigen::Matrix3f turn(Eigen::AngleAxisf(1, Vec3(1, 2, 3).normalized()));
    const Eigen::Matrix3f scaled = turn * Vec3(2, 2, 2).asDiagonal();
    EXPECT_NEAR((nearest_rotation(scaled) - turn).norm(), 0, 1e-4);
    EXPECT_EQ(nearest_rotation(Eigen::Matrix3f::Zero()), Eigen::Matrix3f::Identity());
}

TEST(Influence, IsOfTheJointsBetweenTheBonesOfAVertex) {
    const Animation tube = shapes::bending_tube();
    const StateReader reader = make_rig_state(tube, pointers(tube.clips[0]));
    const std::vector<InfluenceGroup> groups = candidate_influences(tube, reader, 2);
    std::vector<std::vector<std::uint32_t>> of_vertex(tube.rest.vertex_count());
    for (const InfluenceGroup& group : groups)
        for (const std::uint32_t v : group.vertices) of_vertex[v] = group.controls;
    for (std::size_t v = 0; v < of_vertex.size(); ++v) {
        const float x = tube.rest.vertices[v].x();
        if (std::abs(x) < 0.8f) {
            EXPECT_EQ(of_vertex[v], std::vector<std::uint32_t>{1}) << x;  // the elbow, never the root
        }
    }
}

TEST(Influence, TheTestDropsWhatDoesNotMatter) {
    StateReader reader;
    for (std::uint32_t c = 0; c < 3; ++c) reader.controls.push_back({"c" + std::to_string(c), c, 1});
    reader.input_count = 3;
    Random random(1);
    Eigen::MatrixXf states(60, 3), curvature(60, 4);
    for (Eigen::Index i = 0; i < 60; ++i) {
        for (Eigen::Index k = 0; k < 3; ++k) states(i, k) = float(random.uniform());
        const auto noise = [&] { return 1e-3f * float(random.normal()); };
        curvature(i, 0) = states(i, 0) + noise();
        curvature(i, 1) = states(i, 1) * states(i, 1) - 2 * states(i, 2) + noise();
        curvature(i, 2) = noise();  // nothing passes: the best alone stays
        curvature(i, 3) = states(i, 0) + noise();
    }
    const std::vector<InfluenceGroup> possible = {{{0, 1, 2}, {0, 1, 2, 3}}};
    const auto groups = significant_influences(possible, reader, states, curvature, {true, true, true, false}, {});
    std::vector<std::vector<std::uint32_t>> of_vertex(4);
    for (const InfluenceGroup& group : groups)
        for (const std::uint32_t v : group.vertices) of_vertex[v] = group.controls;
    EXPECT_EQ(of_vertex[0], (std::vector<std::uint32_t>{0}));
    EXPECT_EQ(of_vertex[1], (std::vector<std::uint32_t>{1, 2}));
    EXPECT_EQ(of_vertex[2].size(), 1u);
    EXPECT_TRUE(of_vertex[3].empty());
}

}  // namespace
}  // namespace exemplar
