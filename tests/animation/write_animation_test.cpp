#include "host/animation/write_animation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "host/animation/check_animation.h"
#include "host/core/errors.h"
#include "host/core/random.h"
#include "tests/animation/made_up_gltf.h"

namespace exemplar {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

NodeTransform random_transform(Random& random) {
    const auto number = [&] { return static_cast<float>(random.normal()); };
    NodeTransform t;
    t.translation = {number(), number(), number()};
    t.rotation = Eigen::Quaternionf(number(), number(), number(), number()).normalized();
    t.scale = Vec3(1, 1, 1) + 0.1f * Vec3(number(), number(), number());
    return t;
}

/// A grid of 5 x 5 vertices that hangs on six bones, up to five a vertex, two of which share a node; two morph targets,
/// one of which moves nothing; a clip in which everything moves and one of a single frame at rest.
Animation random_rig() {
    Random random(7);
    Animation animation;
    animation.name = "made up";
    animation.kind = AnimationKind::skeleton;
    for (int i = 0, row = 0; i < 25; ++i, row = i / 5)
        animation.rest.vertices.emplace_back(float(i % 5), float(row), 0.01f * float(i));
    for (std::uint32_t i = 0; i < 24; ++i)
        if (i % 5 < 4 && i < 20) animation.rest.faces.push_back({i, i + 1, i + 5});
    animation.rest.source_face_count = static_cast<std::uint32_t>(animation.rest.face_count());
    Rig& rig = animation.rig;
    for (std::uint32_t i = 0; i < 6; ++i)
        rig.nodes.push_back({"node " + std::to_string(i), i == 0 ? k_invalid_index : i / 2, random_transform(random)});
    rig.nodes[1].parent = k_invalid_index;
    for (std::uint32_t i = 0; i < 6; ++i) {
        Affine inverse = Affine::Identity();
        inverse.translation() = random_transform(random).translation;
        rig.bones.push_back({i == 5 ? 2 : i, inverse});
    }
    rig.influence_begin = {0};
    for (std::uint32_t v = 0; v < 25; ++v) {
        for (std::uint32_t b = 0; b < 1 + v % 5; ++b)
            rig.influences.push_back({(b + v) % 6, static_cast<float>(1 + random.uniform())});
        rig.influence_begin.push_back(static_cast<std::uint32_t>(rig.influences.size()));
    }
    rig.targets = {{"öffnen", {3, 7}, {Vec3(0, 0, 1), Vec3(1, 2, 3)}, 0.5f}, {"nothing", {}, {}, 0}};
    animation.clips = {{.name = "dance", .frames_per_second = 24, .poses = {}, .frames = {}},
                       {.name = "stand", .frames_per_second = 24, .poses = {rest_pose(rig)}, .frames = {}}};
    for (int f = 0; f < 10; ++f) {
        Pose pose;
        for (int n = 0; n < 6; ++n) pose.nodes.push_back(random_transform(random));
        pose.weights = {static_cast<float>(random.uniform()), 0};
        animation.clips[0].poses.push_back(pose);
    }
    check_animation(animation);
    animation.warnings.clear();
    return animation;
}

void expect_same_shape(const std::vector<Vec3>& found, const std::vector<Vec3>& expected, float tolerance) {
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t v = 0; v < found.size(); ++v) EXPECT_LT((found[v] - expected[v]).norm(), tolerance) << v;
}

TEST(WriteGltfAnimation, WhatIsWrittenIsReadAgain) {
    const Animation written = random_rig();
    const TemporaryFolder folder;
    write_gltf_animation(folder / "a.glb", written);
    const Animation read = read_animation(folder / "a.glb", {.frames_per_second = 24});
    EXPECT_THAT(read.warnings, IsEmpty());
    EXPECT_EQ(read.kind, AnimationKind::skeleton);
    EXPECT_EQ(read.rest.vertices, written.rest.vertices);
    EXPECT_EQ(read.rest.faces, written.rest.faces);
    ASSERT_THAT(read.rig.targets, SizeIs(2));
    EXPECT_EQ(read.rig.targets[0].name, "öffnen");
    EXPECT_EQ(read.rig.targets[0].vertices, written.rig.targets[0].vertices);
    EXPECT_EQ(read.rig.targets[0].offsets, written.rig.targets[0].offsets);
    EXPECT_EQ(read.rig.targets[0].rest_weight, 0.5f);
    EXPECT_THAT(read.rig.targets[1].vertices, IsEmpty());
    EXPECT_EQ(read.rig.bones.size(), written.rig.bones.size());
    EXPECT_EQ(read.rig.influences.size(), written.rig.influences.size());
    ASSERT_EQ(read.clips.size(), written.clips.size());
    for (std::size_t c = 0; c < read.clips.size(); ++c) {
        EXPECT_EQ(read.clips[c].name, written.clips[c].name);
        ASSERT_EQ(read.clips[c].size(), written.clips[c].size());
        for (std::size_t f = 0; f < read.clips[c].size(); ++f)
            expect_same_shape(frame_vertices(read, read.clips[c], f), frame_vertices(written, written.clips[c], f),
                              1e-4f);
    }
}

TEST(WriteGltfAnimation, TheMeshReaderReadsItToo) {
    const TemporaryFolder folder;
    const Animation written = random_rig();
    write_gltf_animation(folder / "a.glb", written);
    const MeshFile read = read_mesh(folder / "a.glb");
    EXPECT_EQ(read.mesh.faces, written.rest.faces);
    EXPECT_FALSE(read.labels.has_value());
}

TEST(WriteGltfAnimation, BlendShapesOnSeveralNodesDoNotBecomeASkeleton) {
    const TemporaryFolder folder;
    Animation written = random_rig();
    written.kind = AnimationKind::blend_shapes;
    write_gltf_animation(folder / "a.glb", written);
    EXPECT_EQ(read_animation(folder / "a.glb").kind, AnimationKind::blend_shapes);
}

TEST(WriteGltfAnimation, WhatGltfCannotSayIsRefused) {
    const TemporaryFolder folder;
    const auto refused = [&](auto&& damage) {
        Animation animation = random_rig();
        damage(animation);
        EXPECT_THROW(write_gltf_animation(folder / "a.glb", animation), Error);
        EXPECT_FALSE(std::filesystem::exists(folder / "a.glb"));
    };
    refused([](Animation& animation) { animation.kind = AnimationKind::sequence; });
    refused([](Animation& animation) { animation.rest.faces.clear(); });
    refused([](Animation& animation) { animation.rest.vertices[3][1] = NAN; });
    refused([](Animation& animation) { animation.clips[0].poses[2].nodes[1].scale[0] = INFINITY; });
    refused([](Animation& animation) { animation.clips[1].poses.clear(); });
}

TEST(WriteSequence, WhatIsWrittenIsReadAgain) {
    Animation written = random_rig();
    written.clips.pop_back();
    const TemporaryFolder folder;
    write_sequence(folder / "dance", written);
    EXPECT_TRUE(std::filesystem::exists(folder / "dance/0009.ply"));
    const Animation read = read_animation(folder / "dance");
    EXPECT_EQ(read.kind, AnimationKind::sequence);
    EXPECT_EQ(read.rest.faces, written.rest.faces);
    ASSERT_EQ(read.clips.at(0).size(), 10u);
    EXPECT_EQ(read.clips[0].name, "dance");
    for (std::size_t f = 0; f < 10; ++f)
        EXPECT_EQ(read.clips[0].frames[f], frame_vertices(written, written.clips[0], f));
    std::vector<Vec3> rest;
    pose_vertices(written.rig, written.rest.vertices, rest_pose(written.rig), rest);
    EXPECT_EQ(read.rest.vertices, rest);
}

TEST(WriteSequence, SeveralClipsGoToFoldersOfTheirOwn) {
    Animation written = random_rig();
    written.clips[0].name = written.clips[1].name = "a/b";
    const TemporaryFolder folder;
    write_sequence(folder.path(), written);
    EXPECT_EQ(read_animation(folder / "a_b").clips.at(0).size(), 10u);
    EXPECT_EQ(read_animation(folder / "a_b (2)").clips.at(0).size(), 1u);
}

TEST(WriteSequence, FramesOfAnotherMotionAreNotMixedIn) {
    Animation written = random_rig();
    written.clips.pop_back();
    const TemporaryFolder folder;
    mesh_files::write_bytes(folder / "old.OBJ", "v 0 0 0\n");
    EXPECT_THAT(mesh_files::error_of<DataError>([&] { write_sequence(folder.path(), written); }),
                HasSubstr("holds old.OBJ already"));
    written.clips.clear();
    EXPECT_THROW(write_sequence(folder.path(), written), UsageError);
}

}  // namespace
}  // namespace exemplar
