#include "host/animation/check_animation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "host/core/errors.h"
#include "tests/animation/made_up_gltf.h"
#include "tests/support/shapes.h"

namespace exemplar {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

Animation bending() {
    return made_up::bending_arm().read(4);
}

/// What check_animation says of the bending arm after `damage` to it.
template <typename Damage>
std::string check_error_after(Damage&& damage) {
    Animation animation = bending();
    animation.name = "the arm";
    damage(animation);
    std::string message = mesh_files::error_of<MeshError>([&] { check_animation(animation); });
    EXPECT_THAT(message, testing::StartsWith("the arm: "));
    return message;
}

TEST(CheckAnimation, ASoundOneStaysAsItIs) {
    Animation animation = bending();
    const Animation before = animation;
    check_animation(animation);
    EXPECT_THAT(animation.warnings, IsEmpty());
    EXPECT_EQ(animation.rest.faces, before.rest.faces);
    ASSERT_EQ(animation.rig.influences.size(), before.rig.influences.size());
    for (std::size_t i = 0; i < before.rig.influences.size(); ++i)
        EXPECT_EQ(animation.rig.influences[i].weight, before.rig.influences[i].weight);
    EXPECT_EQ(animation.frame_count(), before.frame_count());
}

TEST(CheckAnimation, InfluencesBecomeWhatARigPromises) {
    Rig rig;
    rig.nodes.resize(3);
    rig.bones = {{0, Affine::Identity()}, {1, Affine::Identity()}, {2, Affine::Identity()}};
    rig.influence_begin = {0, 3, 5, 7, 7, 9};
    rig.influences = {{2, 1.0f},  {0, 2.0f},     {2, 1.0f},  // out of order, one bone twice, sum four
                      {0, 1.0f},  {1, 0.00009f},             // too small to see
                      {1, 0.0f},  {2, 0.0f},                 // no weight
                      {0, -0.5f}, {1, 1.0f}};                // what no format allows
    std::vector<std::string> warnings;
    clean_influences(rig, "x", warnings);
    const auto row = [&](std::size_t v) {
        std::vector<std::pair<std::uint32_t, float>> pairs;
        for (const Influence& influence : rig.influences_of(v)) pairs.emplace_back(influence.bone, influence.weight);
        return pairs;
    };
    using testing::Pair;
    EXPECT_THAT(row(0), ElementsAre(Pair(0, 0.5f), Pair(2, 0.5f)));
    EXPECT_THAT(row(1), ElementsAre(Pair(0, 1.0f)));
    EXPECT_THAT(row(2), ElementsAre(Pair(1, 1.0f)));
    EXPECT_THAT(row(3), ElementsAre(Pair(0, 1.0f)));
    EXPECT_THAT(row(4), ElementsAre(Pair(1, 1.0f)));
    EXPECT_THAT(warnings, ElementsAre(HasSubstr("2 vertices have no weight"),
                                      AllOf(HasSubstr("1 vertices"), HasSubstr("off by up to 3"))));
}

TEST(CheckAnimation, WeightsOfAnySizeEndBetweenZeroAndOne) {
    Rig rig;
    rig.nodes.resize(1);
    rig.bones = {{0, Affine::Identity()}, {0, Affine::Identity()}};
    const float largest = std::numeric_limits<float>::max(), least = std::numeric_limits<float>::denorm_min();
    rig.influence_begin = {0, 3, 5, 6};
    rig.influences = {{0, largest}, {0, largest}, {1, largest}, {0, least}, {1, least}, {1, 1.0000005f}};
    std::vector<std::string> warnings;
    clean_influences(rig, "x", warnings);
    ASSERT_EQ(rig.influence_begin, (std::vector<std::uint32_t>{0, 2, 4, 5}));
    EXPECT_NEAR(rig.influences[0].weight, 2.0f / 3, 1e-6);
    EXPECT_NEAR(rig.influences[1].weight, 1.0f / 3, 1e-6);
    EXPECT_EQ(rig.influences[2].weight, 0.5f);
    EXPECT_EQ(rig.influences[4].weight, 1.0f);
}

TEST(CheckAnimation, WhatDoesNotFitIsRefused) {
    EXPECT_THAT(check_error_after([](Animation& a) { a.rest.faces.clear(); }), HasSubstr("no faces"));
    EXPECT_THAT(check_error_after([](Animation& a) { a.rest.faces[1][2] = 6; }), HasSubstr("vertex 6"));
    EXPECT_THAT(check_error_after([](Animation& a) { a.rest.vertices[1][0] = NAN; }), HasSubstr("vertex 1"));
    EXPECT_THAT(check_error_after([](Animation& a) { a.vertex_of_source[2] = 6; }), HasSubstr("vertex 6"));
    EXPECT_THAT(check_error_after([](Animation& a) { a.rig.nodes[0].parent = 1; }), HasSubstr("node 0"));
    EXPECT_THAT(check_error_after([](Animation& a) { a.rig.bones[1].node = 2; }), HasSubstr("bone 1 names node 2"));
    EXPECT_THAT(check_error_after([](Animation& a) { a.rig.bones[1].inverse_bind.translation()[0] = INFINITY; }),
                HasSubstr("bone 1"));
    EXPECT_THAT(check_error_after([](Animation& a) { a.rig.influences[0].bone = 2; }), HasSubstr("bone 2"));
    EXPECT_THAT(check_error_after([](Animation& a) { a.rig.influences[0].weight = NAN; }), HasSubstr("vertex 0"));
    EXPECT_THAT(check_error_after([](Animation& a) { a.rig.influence_begin.pop_back(); }),
                HasSubstr("number of vertices"));
    EXPECT_THAT(check_error_after([](Animation& a) {
                    a.rig.targets = {{"t", {1, 1}, {Vec3::Zero(), Vec3::Zero()}, 0}};
                }),
                HasSubstr("'t' moves vertex 1"));
    EXPECT_THAT(check_error_after([](Animation& a) { a.rig.targets = {{"t", {1}, {}, 0}}; }), HasSubstr("0 offsets"));
    EXPECT_THAT(check_error_after([](Animation& a) {
                    a.rig.targets = {{"t", {1}, {Vec3(0, NAN, 0)}, 0}};
                }),
                HasSubstr("not finite"));
    EXPECT_THAT(check_error_after([](Animation& a) { a.clips[0].poses[1].nodes.pop_back(); }),
                HasSubstr("'bend': frame 1 has 1 nodes"));
    EXPECT_THAT(check_error_after([](Animation& a) { a.clips[0].poses.clear(); }), HasSubstr("no frames"));
    EXPECT_THAT(check_error_after([](Animation& a) { a.clips[0].frames_per_second = 0; }), HasSubstr("no rate"));
    EXPECT_THAT(check_error_after([](Animation& a) { a.clips[0].frames = {a.rest.vertices}; }), HasSubstr("poses"));
}

TEST(CheckAnimation, FacesThatNameAVertexTwiceGoWithTheirSources) {
    Animation animation = bending();
    animation.rest.faces[1] = {1, 1, 2};
    animation.rest.source_face = {0, 0, 1, 1};
    animation.rest.source_face_count = 2;
    check_animation(animation);
    EXPECT_THAT(animation.rest.faces, SizeIs(3));
    EXPECT_THAT(animation.rest.source_face, ElementsAre(0, 1, 1));
    EXPECT_EQ(animation.rest.source_face_count, 2u);
}

TEST(CheckAnimation, FacesThatLieOnOthersGoAndOthersFaceOutwardAtRest) {
    const TriangleMesh box = shapes::box(1, 2, 3, 2);
    Animation animation;
    animation.rest = box;
    for (Face& face : animation.rest.faces) std::swap(face[1], face[2]);
    for (const auto& [a, b, c] : box.faces) animation.rest.faces.push_back({b, c, a});
    animation.rest.source_face_count = static_cast<std::uint32_t>(animation.rest.face_count());
    check_animation(animation);
    EXPECT_EQ(animation.rest.faces, box.faces);
    EXPECT_THAT(animation.rest.source_face, IsEmpty());
    EXPECT_EQ(animation.rest.source_face_count, box.face_count());
    EXPECT_THAT(animation.warnings, ElementsAre(HasSubstr("48 faces lie on others"), HasSubstr("inside out")));
}

TEST(CheckAnimation, TheRestPoseDecidesWhatFacesOutward) {
    // The bone mirrors the surface: what faces outward before skinning is inside out in the pose.
    Animation animation;
    animation.kind = AnimationKind::skeleton;
    animation.rest = shapes::box(1, 2, 3, 2);
    const std::vector<Face> faces = animation.rest.faces;
    Rig& rig = animation.rig;
    rig.nodes.resize(1);
    rig.nodes[0].parent = k_invalid_index;
    rig.nodes[0].rest.scale = {-1, 1, 1};
    rig.bones = {{}};
    rig.influences.assign(animation.rest.vertex_count(), {0, 1.0f});
    for (std::uint32_t v = 0; v <= animation.rest.vertex_count(); ++v) rig.influence_begin.push_back(v);
    check_animation(animation);
    ASSERT_EQ(animation.rest.face_count(), faces.size());
    for (std::size_t f = 0; f < faces.size(); ++f)
        EXPECT_EQ(animation.rest.faces[f], (Face{faces[f][0], faces[f][2], faces[f][1]}));
}

TEST(CheckAnimation, CollapsedFacesAndStillClipsAreRemarked) {
    Animation animation = bending();
    animation.rest.vertices[1] = {0.5f, 0, 0};  // on the line from 0 to 2, as long as the arm is straight or not
    animation.clips.push_back(animation.clips[0]);
    animation.clips[1].name = "stand";
    for (Pose& pose : animation.clips[1].poses) pose = animation.clips[1].poses[0];
    check_animation(animation);
    EXPECT_THAT(animation.warnings, testing::UnorderedElementsAre(HasSubstr("'stand' never moves"),
                                                                  HasSubstr("1 faces have no area in most frames")));
}

TEST(CheckAnimation, TheSameRotationWithOtherSignsIsNoMotion) {
    Animation animation = bending();
    Clip& clip = animation.clips[0];
    for (Pose& pose : clip.poses) pose = clip.poses[0];
    clip.poses[1].nodes[0].rotation.coeffs() *= -1;
    check_animation(animation);
    EXPECT_THAT(animation.warnings, ElementsAre(HasSubstr("never moves")));
}

}  // namespace
}  // namespace exemplar
