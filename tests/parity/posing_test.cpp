#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <vector>

#include "gpu/curvature/surface/poser.h"
#include "host/core/errors.h"
#include "host/core/random.h"
#include "tests/gpu/support/environment.h"
#include "tests/parity/surfaces.h"

// Both add the same products in single precision, but the device may fuse a product with its sum and adds the columns
// of the matrix in another order. With six influences and tens of targets that is below twenty roundings of sums that
// are no larger than what they add up, so 20 x 6e-8 of the sum of all magnitudes, which is here below thirty times the
// size of the result.
namespace exemplar {
namespace {

using shared::vec4;
using test_support::download;
using test_support::random_pose;
using test_support::random_rig;
using test_support::shared_device;

constexpr float k_posing_tolerance = 4e-5f;

std::vector<Vec3> random_rest_points(std::size_t count, Random& random) {
    std::vector<Vec3> points;
    for (std::size_t i = 0; i < count; ++i) points.push_back(test_support::random_vec3(random));
    return points;
}

void expect_near_points(const std::vector<vec4>& actual, const std::vector<Vec3>& expected) {
    ASSERT_EQ(actual.size(), expected.size());
    float size = 1.0f;
    for (const Vec3& v : expected) size = std::max(size, v.norm());
    for (std::size_t v = 0; v < expected.size(); ++v) {
        ASSERT_LE((test_support::xyz(actual[v]) - expected[v]).norm(), k_posing_tolerance * size) << "vertex " << v;
        ASSERT_EQ(actual[v].w, 1.0f) << "vertex " << v;
    }
}

std::vector<Vec3> reference(const Rig& rig, const std::vector<Vec3>& rest, const Pose& pose) {
    std::vector<Vec3> posed;
    pose_vertices(rig, rest, pose, posed);
    return posed;
}

void expect_posing_parity(std::size_t vertices, std::size_t bones, std::size_t targets, Random& random) {
    const Rig rig = random_rig(vertices, bones, targets, random);
    const std::vector<Vec3> rest = random_rest_points(vertices, random);
    GpuPoser poser(shared_device(), rig, rest);
    Stream stream(shared_device());
    for (int frame = 0; frame < 3; ++frame) {
        const Pose pose = random_pose(rig, random);
        poser.record(stream, pose);
        stream.finish();
        expect_near_points(download(poser.vertices()), reference(rig, rest, pose));
    }
}

TEST(PosingParity, OddNumbersOfVertices) {
    Random random(1);
    for (const std::size_t vertices : {0u, 1u, 63u, 64u, 65u, 1003u}) {
        SCOPED_TRACE(vertices);
        expect_posing_parity(vertices, 20, 7, random);
    }
}

TEST(PosingParity, RigsOfAnySize) {
    Random random(2);
    for (const std::size_t bones : {1u, 2u, 6u, 200u})
        for (const std::size_t targets : {0u, 1u, 3u, 4u, 60u}) {
            SCOPED_TRACE(::testing::Message() << bones << " bones, " << targets << " targets");
            expect_posing_parity(150, bones, targets, random);
        }
}

TEST(PosingParity, VerticesAreAtRestBeforeTheFirstPose) {
    Random random(3);
    const std::vector<Vec3> rest = random_rest_points(70, random);
    const GpuPoser poser(shared_device(), random_rig(70, 3, 1, random), rest);
    const std::vector<vec4> vertices = download(poser.vertices());
    for (std::size_t v = 0; v < rest.size(); ++v) ASSERT_EQ(test_support::xyz(vertices[v]), rest[v]);
}

// What is recorded next to each other runs one after the other, each with its own pose.
TEST(PosingParity, ManyPosesInOneSubmission) {
    Random random(4);
    const Rig rig = random_rig(130, 10, 3, random);
    const std::vector<Vec3> rest = random_rest_points(130, random);
    GpuPoser poser(shared_device(), rig, rest);
    Stream stream(shared_device());
    std::vector<Pose> poses;
    std::vector<std::vector<vec4>> frames(9, std::vector<vec4>(rest.size()));
    for (std::vector<vec4>& frame : frames) {
        poser.record(stream, poses.emplace_back(random_pose(rig, random)));
        stream.download(poser.vertices(), std::span(frame));
    }
    stream.finish();
    for (std::size_t i = 0; i < frames.size(); ++i) expect_near_points(frames[i], reference(rig, rest, poses[i]));
}

TEST(PosingParity, SequencesSetTheirVertices) {
    Random random(5);
    const std::vector<Vec3> rest = random_rest_points(65, random), frame = random_rest_points(65, random);
    GpuPoser poser(shared_device(), Rig{}, rest);
    Stream stream(shared_device());
    poser.set_vertices(stream, frame);
    stream.finish();
    const std::vector<vec4> vertices = download(poser.vertices());
    for (std::size_t v = 0; v < frame.size(); ++v) ASSERT_EQ(test_support::xyz(vertices[v]), frame[v]);
    EXPECT_THROW(poser.set_vertices(stream, std::span(frame).first(64)), UsageError);
    EXPECT_THROW(poser.record(stream, Pose{}), UsageError);
}

TEST(PosingParity, IsDeterministic) {
    Random random(6);
    const Rig rig = random_rig(500, 30, 20, random);
    const std::vector<Vec3> rest = random_rest_points(500, random);
    const Pose pose = random_pose(rig, random), other = random_pose(rig, random);
    GpuPoser poser(shared_device(), rig, rest);
    Stream stream(shared_device());
    const auto posed = [&](const Pose& p) {
        poser.record(stream, p);
        stream.finish();
        return download(poser.vertices());
    };
    const std::vector<vec4> first = posed(pose);
    posed(other);
    const std::vector<vec4> second = posed(pose);
    EXPECT_EQ(std::memcmp(first.data(), second.data(), first.size() * sizeof(vec4)), 0);
}

TEST(PosingParity, RefusesContradictions) {
    Random random(7);
    const std::vector<Vec3> rest = random_rest_points(20, random);
    const Rig good = random_rig(20, 4, 2, random);
    const auto refused = [&](auto&& change) {
        Rig rig = good;
        change(rig);
        EXPECT_THROW(GpuPoser(shared_device(), rig, rest), UsageError);
    };
    refused([](Rig& rig) { rig.influences[3].bone = 4; });
    refused([](Rig& rig) { rig.influence_begin.pop_back(); });
    refused([](Rig& rig) { rig.influence_begin[5] = rig.influence_begin[6]; });
    refused([](Rig& rig) { rig.influences.pop_back(); });
    refused([](Rig& rig) { rig.targets[1] = {"stray", {20}, {Vec3::Zero()}}; });
    refused([](Rig& rig) { rig.targets[1] = {"short", {1, 2}, {Vec3::Zero()}}; });
    refused([](Rig& rig) { rig.bones[2].node = 4; });
    refused([](Rig& rig) { rig.nodes[1].parent = 2; });

    GpuPoser poser(shared_device(), good, rest);
    Stream stream(shared_device());
    Pose pose = random_pose(good, random);
    pose.weights.pop_back();
    EXPECT_THROW(poser.record(stream, pose), UsageError);
    pose = random_pose(good, random);
    pose.nodes.pop_back();
    EXPECT_THROW(poser.record(stream, pose), UsageError);
}

}  // namespace
}  // namespace exemplar
