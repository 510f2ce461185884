#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "host/core/errors.h"
#include "tests/animation/made_up_gltf.h"

namespace exemplar {
namespace {

using made_up::arm;
using made_up::bending_arm;
using made_up::face;
using made_up::Gltf;
using made_up::Json;
using made_up::k_lower;
using made_up::k_surface;
using made_up::k_upper;
using made_up::warnings_of;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

void expect_near(const Vec3& found, const Vec3& expected, float tolerance = 1e-5f) {
    EXPECT_LT((found - expected).norm(), tolerance) << found.transpose() << " instead of " << expected.transpose();
}

/// The vertex of a surface at a place of its rest shape.
std::size_t vertex_at(const Animation& animation, const Vec3& place) {
    for (std::size_t v = 0; v < animation.rest.vertex_count(); ++v)
        if ((animation.rest.vertices[v] - place).norm() < 1e-6f) return v;
    ADD_FAILURE() << "no vertex at " << place.transpose();
    return 0;
}

TEST(ReadGltfAnimation, ASkinTurnsItsSurface) {
    const Animation animation = bending_arm().read();
    EXPECT_EQ(animation.kind, AnimationKind::skeleton);
    EXPECT_THAT(animation.warnings, IsEmpty());
    EXPECT_THAT(animation.rest.vertices, SizeIs(6));
    EXPECT_THAT(animation.rest.faces, SizeIs(4));
    EXPECT_EQ(animation.rest.source_face_count, 4u);
    EXPECT_THAT(animation.vertex_of_source, ElementsAre(0, 1, 2, 3, 4, 5));
    ASSERT_THAT(animation.clips, SizeIs(1));
    EXPECT_EQ(animation.clips[0].name, "bend");
    ASSERT_EQ(animation.clips[0].size(), 31u);
    EXPECT_EQ(frame_vertices(animation, animation.clips[0], 0), animation.rest.vertices);
    const std::vector<Vec3> last = frame_vertices(animation, animation.clips[0], 30);
    expect_near(last[0], {0, 0, 0});
    expect_near(last[4], {1, 1, 0});
    expect_near(last[5], {0, 1, 0});
    expect_near(last[3], {0.5f, 0.5f, 0});  // half of (1, 1, 0) and of (0, 0, 0)
    const std::vector<Vec3> middle = frame_vertices(animation, animation.clips[0], 15);
    const float s = std::numbers::sqrt2_v<float> / 2;
    expect_near(middle[4], {1 + s, s, 0});
}

TEST(ReadGltfAnimation, ParentsComeBeforeChildrenAndNodesThatMoveNothingAreLeftOut) {
    const Animation animation = bending_arm().read();
    ASSERT_THAT(animation.rig.nodes, SizeIs(2));
    EXPECT_EQ(animation.rig.nodes[0].name, "upper");
    EXPECT_EQ(animation.rig.nodes[0].parent, k_invalid_index);
    EXPECT_EQ(animation.rig.nodes[1].name, "lower");
    EXPECT_EQ(animation.rig.nodes[1].parent, 0u);
    EXPECT_THAT(animation.rig.bones, SizeIs(2));
}

TEST(ReadGltfAnimation, WithoutInverseBindMatricesTheyAreTheIdentity) {
    Gltf gltf = arm();
    gltf.json["skins"][0].erase("inverseBindMatrices");
    const Animation animation = gltf.read();
    for (const Bone& bone : animation.rig.bones) EXPECT_TRUE(bone.inverse_bind.matrix().isIdentity(0));
    EXPECT_THAT(animation.clips, IsEmpty());
}

/// The translation of the lower arm along x in each frame of a clip.
std::vector<float> sampled(const std::string& interpolation, const std::vector<float>& times,
                           const std::vector<float>& x, double frames_per_second) {
    Gltf gltf = arm();
    gltf.json["animations"] = Json::array({{{"name", "move"}}});
    std::vector<float> values;
    for (const float value : x) values.insert(values.end(), {value, 0, 0});
    gltf.channel(0, k_lower, "translation", times, gltf.accessor(values, "VEC3"), interpolation);
    const Animation animation = gltf.read(frames_per_second);
    std::vector<float> found;
    for (const Pose& pose : animation.clips.at(0).poses) found.push_back(pose.nodes[1].translation[0]);
    return found;
}

TEST(ReadGltfAnimation, StepsLinesAndSplinesAreInterpolated) {
    using testing::FloatNear;
    const auto near = [](float x) { return FloatNear(x, 1e-5f); };
    EXPECT_THAT(sampled("STEP", {0, 0.5f, 1}, {1, 2, 4}, 4), ElementsAre(1, 1, 2, 2, 4));
    EXPECT_THAT(sampled("LINEAR", {0, 0.5f, 1}, {1, 2, 4}, 4),
                ElementsAre(near(1), near(1.5f), near(2), near(3), near(4)));
    // In-tangent, value, out-tangent: with these tangents the spline is t^3 on [0, 2].
    EXPECT_THAT(sampled("CUBICSPLINE", {0, 2}, {9, 0, 0, 12, 8, 9}, 2),
                ElementsAre(near(0), near(0.125f), near(1), near(3.375f), near(8)));
}

TEST(ReadGltfAnimation, BeforeItsFirstAndAfterItsLastKeyANumberRests) {
    Gltf gltf = arm();
    gltf.json["animations"] = Json::array({{{"name", "two"}}});
    gltf.channel(0, k_lower, "translation", {0.5f, 0.75f}, gltf.accessor<float>({3, 0, 0, 5, 0, 0}, "VEC3"));
    gltf.channel(0, k_upper, "scale", {0, 1}, gltf.accessor<float>({1, 1, 1, 3, 1, 1}, "VEC3"));
    const Animation animation = gltf.read(4);
    std::vector<float> x, scale;
    for (const Pose& pose : animation.clips.at(0).poses) {
        x.push_back(pose.nodes[1].translation[0]);
        scale.push_back(pose.nodes[0].scale[0]);
    }
    EXPECT_THAT(x, ElementsAre(3, 3, 3, 5, 5));
    EXPECT_THAT(scale, ElementsAre(1, 1.5f, 2, 2.5f, 3));
}

TEST(ReadGltfAnimation, KeysOnTheGridOfFramesAreHitInSpiteOfRounding) {
    std::vector<float> times, x;
    for (int i = 0; i < 400; ++i) {
        times.push_back(static_cast<float>(i) / 30);
        x.push_back(static_cast<float>(i));
    }
    EXPECT_EQ(sampled("STEP", times, x, 30), x);
}

TEST(ReadGltfAnimation, RotationsTakeTheShorterWayAndStayUnit) {
    for (const std::string interpolation : {"LINEAR", "CUBICSPLINE"}) {
        Gltf gltf = arm();
        gltf.json["animations"] = Json::array({{{"name", "turn"}}});
        const float s = std::numbers::sqrt2_v<float> / 2;
        std::vector<float> values{0, 0, 0, 2, 0, 0, -s, -s};  // the second is the quarter turn, negated
        if (interpolation == "CUBICSPLINE")
            values = {0, 0, 0, 0, 0, 0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, s, s, 0, 0, 0, 0};
        gltf.channel(0, k_lower, "rotation", {0, 1}, gltf.accessor(values, "VEC4"), interpolation);
        const Animation animation = gltf.read(2);
        ASSERT_THAT(animation.clips.at(0).poses, SizeIs(3));
        for (const Pose& pose : animation.clips[0].poses) EXPECT_NEAR(pose.nodes[1].rotation.norm(), 1, 1e-6);
        const Eigen::Quaternionf middle = animation.clips[0].poses[1].nodes[1].rotation;
        if (interpolation == "LINEAR") {
            const Eigen::AngleAxisf eighth(std::numbers::pi_v<float> / 4, Vec3::UnitZ());
            EXPECT_LT(middle.angularDistance(Eigen::Quaternionf(eighth)), 1e-3f);
        } else {  // of the components 0.5 (0, 2) + 0.5 (s, s), normalized
            EXPECT_NEAR(middle.z() / middle.w(), s / (2 + s), 1e-5);
        }
    }
}

TEST(ReadGltfAnimation, NormalizedIntegersStandForFractions) {
    Gltf gltf = arm();
    Json& attributes = gltf.json["meshes"][0]["primitives"][0]["attributes"];
    attributes["WEIGHTS_0"] = gltf.accessor<std::uint8_t>(
        {255, 0, 0, 0, 255, 0, 0, 0, 51, 204, 0, 0, 51, 204, 0, 0, 255, 0, 0, 0, 255, 0, 0, 0}, "VEC4",
        made_up::k_ubyte, true);
    gltf.json["animations"] = Json::array({{{"name", "turn"}}});
    gltf.channel(0, k_lower, "rotation", {0, 1},
                 gltf.accessor<std::int16_t>({0, 0, 0, 32767, 0, 0, -32768, 0}, "VEC4", made_up::k_short, true));
    const Animation animation = gltf.read(1);
    ASSERT_THAT(animation.rig.influences_of(2), SizeIs(2));
    EXPECT_NEAR(animation.rig.influences_of(2)[0].weight, 0.2f, 1e-6);
    EXPECT_NEAR(animation.rig.influences_of(2)[1].weight, 0.8f, 1e-6);
    EXPECT_NEAR(std::abs(animation.clips.at(0).poses.at(1).nodes[1].rotation.z()), 1, 1e-6);
}

TEST(ReadGltfAnimation, FurtherSetsOfJointsCount) {
    Gltf gltf = arm();
    Json& attributes = gltf.json["meshes"][0]["primitives"][0]["attributes"];
    std::vector<std::uint16_t> joints(24, 0);
    std::vector<float> weights(24, 0);
    joints[0] = 1;  // the first vertex hangs on the lower arm as well
    weights[0] = 3;
    attributes["JOINTS_1"] = gltf.accessor(joints, "VEC4", made_up::k_ushort);
    attributes["WEIGHTS_1"] = gltf.accessor(weights, "VEC4");
    const Animation animation = gltf.read();
    ASSERT_THAT(animation.rig.influences_of(0), SizeIs(2));
    EXPECT_NEAR(animation.rig.influences_of(0)[1].weight, 0.75f, 1e-6);
    EXPECT_THAT(animation.warnings, ElementsAre(HasSubstr("1 vertices did not sum to one (off by up to 3)")));
}

/// An arm whose two halves are primitives of their own, so that the middle pair is there twice.
Gltf split_arm() {
    Gltf gltf = bending_arm();
    Json& primitives = gltf.json["meshes"][0]["primitives"];
    Json second = primitives[0];
    primitives[0]["indices"] = gltf.accessor<std::uint16_t>({0, 2, 1, 1, 2, 3}, "SCALAR", made_up::k_ushort);
    second["indices"] = gltf.accessor<std::uint16_t>({2, 4, 3, 3, 4, 5}, "SCALAR", made_up::k_ushort);
    primitives.push_back(second);
    return gltf;
}

TEST(ReadGltfAnimation, SeamsBetweenPrimitivesMeshesAndSkinsAreWelded) {
    Gltf gltf = split_arm();
    const Animation expected = bending_arm().read();
    const Animation welded = gltf.read();
    EXPECT_EQ(welded.rest.vertices, expected.rest.vertices);
    EXPECT_EQ(welded.rest.faces, expected.rest.faces);
    EXPECT_THAT(welded.vertex_of_source, ElementsAre(0, 1, 2, 3, 4, 5, 0, 1, 2, 3, 4, 5));

    Json& json = gltf.json;
    json["meshes"].push_back({{"primitives", Json::array({json["meshes"][0]["primitives"][1]})}});
    json["meshes"][0]["primitives"].erase(1);
    json["skins"].push_back(json["skins"][0]);
    json["nodes"].push_back({{"mesh", 1}, {"skin", 1}});
    json["scenes"][0]["nodes"].push_back(3);
    const Animation of_two = gltf.read();
    EXPECT_EQ(of_two.rest.vertices, expected.rest.vertices);
    EXPECT_EQ(of_two.rest.faces, expected.rest.faces);
    EXPECT_THAT(of_two.rig.bones, SizeIs(2));
}

TEST(ReadGltfAnimation, VerticesThatCanPartAreNotWelded) {
    // In the second primitive the middle pair hangs on the lower arm alone.
    Gltf gltf = split_arm();
    Json& attributes = gltf.json["meshes"][0]["primitives"][1]["attributes"];
    attributes["WEIGHTS_0"] =
        gltf.accessor<float>({1, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4");
    EXPECT_THAT(gltf.read().rest.vertices, SizeIs(8));
    // A step of eight bits is rounding.
    const float more = 0.5f + 0.9f / 255;
    attributes["WEIGHTS_0"] = gltf.accessor<float>(
        {1, 0, 0, 0, 1, 0, 0, 0, 1 - more, more, 0, 0, 1 - more, more, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4");
    EXPECT_THAT(gltf.read().rest.vertices, SizeIs(6));
}

TEST(ReadGltfAnimation, UnindexedTrianglesAreWeldedByWhatMovesThem) {
    Gltf gltf = face({"open"});
    Json& primitive = gltf.json["meshes"][0]["primitives"][0];
    const std::vector<float> square{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1, 0, 1, 0, 0, 1, 1, 0};
    primitive["attributes"]["POSITION"] = gltf.accessor(square, "VEC3");
    std::vector<float> offsets(18, 0);
    primitive["targets"][0]["POSITION"] = gltf.accessor(offsets, "VEC3");
    EXPECT_THAT(gltf.read().vertex_of_source, ElementsAre(0, 1, 2, 2, 1, 3));
    offsets[3 * 4 + 2] = 1;  // like lips, the two triangles part at one end of their common edge
    primitive["targets"][0]["POSITION"] = gltf.accessor(offsets, "VEC3");
    const Animation animation = gltf.read();
    EXPECT_THAT(animation.vertex_of_source, ElementsAre(0, 1, 2, 2, 3, 4));
    EXPECT_THAT(animation.rig.targets.at(0).vertices, ElementsAre(3));
}

TEST(ReadGltfAnimation, FacesThatWeldingCollapsesAreLeftOut) {
    Gltf gltf = bending_arm();
    Json& primitive = gltf.json["meshes"][0]["primitives"][0];
    primitive["indices"] = gltf.accessor<std::uint16_t>({0, 2, 1, 4, 4, 5}, "SCALAR", made_up::k_ushort);
    const Animation animation = gltf.read();
    EXPECT_THAT(animation.rest.faces, ElementsAre(Face{0, 2, 1}));
    EXPECT_THAT(warnings_of(animation), HasSubstr("1 faces without area"));
}

TEST(ReadGltfAnimation, MatricesAreTakenApart) {
    Gltf gltf = arm();
    // A quarter turn about z of what is scaled by (2, -3, 4), moved to (5, 6, 7); in columns.
    gltf.json["nodes"][k_upper]["matrix"] = {0, 2, 0, 0, 3, 0, 0, 0, 0, 0, 4, 0, 5, 6, 7, 1};
    const Animation animation = gltf.read();
    EXPECT_THAT(animation.warnings, IsEmpty());
    const Affine world = node_transforms(animation.rig, rest_pose(animation.rig))[0];
    expect_near(world * Vec3(1, 0, 0), {5, 8, 7});
    expect_near(world * Vec3(0, 1, 0), {8, 6, 7});
    expect_near(world * Vec3(0, 0, 1), {5, 6, 11});
    EXPECT_NEAR(animation.rig.nodes[0].rest.rotation.norm(), 1, 1e-6);

    gltf.json["nodes"][k_upper]["matrix"] = {1, 0, 0, 0, 0.5, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    EXPECT_THAT(warnings_of(gltf.read()), HasSubstr("node 1 ('upper') shears"));
}

TEST(ReadGltfAnimation, FacesOfAMirroredNodeAreTurned) {
    Gltf gltf = arm();
    EXPECT_EQ(gltf.read().rest.faces[0], (Face{0, 2, 1}));
    gltf.json["nodes"][k_surface]["scale"] = {1, -1, 1};
    EXPECT_EQ(gltf.read().rest.faces[0], (Face{0, 1, 2}));
    gltf.json["nodes"].push_back({{"children", {k_surface}}, {"scale", {-1, 1, 1}}});
    gltf.json["scenes"][0]["nodes"] = {3};
    EXPECT_EQ(gltf.read().rest.faces[0], (Face{0, 2, 1}));
}

TEST(ReadGltfAnimation, AMeshWithoutSkinFollowsItsNode) {
    Gltf gltf = bending_arm();
    Json& json = gltf.json;
    const std::size_t position = gltf.accessor<float>({0, 0, 1, 1, 0, 1, 0, 1, 1}, "VEC3");
    json["meshes"].push_back({{"primitives", Json::array({{{"attributes", {{"POSITION", position}}}}})}});
    json["nodes"][k_lower]["mesh"] = 1;  // a glove
    json["scenes"][0]["nodes"].push_back(k_upper);
    const Animation animation = gltf.read();
    EXPECT_EQ(animation.kind, AnimationKind::skeleton);
    EXPECT_THAT(animation.rig.bones, SizeIs(3));
    const std::size_t v = vertex_at(animation, {1, 0, 1});
    ASSERT_THAT(animation.rig.influences_of(v), SizeIs(1));
    expect_near(frame_vertices(animation, animation.clips[0], 0)[v], {2, 0, 1});
    expect_near(frame_vertices(animation, animation.clips[0], 30)[v], {1, 1, 1});
}

/// Two triangles that meet along an edge, each on a node; the second, a child, opens like a door in a second.
Gltf door() {
    Gltf gltf = face({});
    gltf.json["meshes"].push_back({{"primitives", Json::array({{{"attributes", {{"POSITION", 0}}}}})}});
    gltf.json["nodes"][0]["children"] = {1};
    gltf.json["nodes"][0]["translation"] = {0, 0, 1};
    gltf.json["nodes"].push_back({{"name", "wing"}, {"mesh", 1}, {"scale", {-1, 1, 1}}});
    gltf.json["animations"] = Json::array({{{"name", "open"}}});
    const std::vector<float> turn = made_up::quarter_turn();  // about y
    gltf.channel(0, 1, "rotation", {0, 1}, gltf.accessor<float>({0, 0, 0, 1, 0, turn[2], 0, turn[3]}, "VEC4"));
    return gltf;
}

TEST(ReadGltfAnimation, NodesThatMoveMakeASequence) {
    const Animation animation = door().read(2);
    EXPECT_EQ(animation.kind, AnimationKind::sequence);
    EXPECT_THAT(animation.warnings, IsEmpty());
    EXPECT_TRUE(animation.rig.nodes.empty() && animation.rig.bones.empty());
    EXPECT_EQ(animation.rest.vertices, (std::vector<Vec3>{{0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {-1, 0, 1}}));
    EXPECT_THAT(animation.rest.faces, ElementsAre(Face{0, 1, 2}, Face{0, 2, 3}));
    EXPECT_THAT(animation.vertex_of_source, ElementsAre(0, 1, 2, 0, 3, 2));
    ASSERT_THAT(animation.clips, SizeIs(1));
    EXPECT_EQ(animation.clips[0].name, "open");
    ASSERT_EQ(animation.clips[0].size(), 3u);
    EXPECT_EQ(animation.clips[0].frames_per_second, 2);
    EXPECT_EQ(animation.clips[0].frames[0], animation.rest.vertices);
    const float s = std::numbers::sqrt2_v<float> / 2;
    expect_near(animation.clips[0].frames[1][3], {-s, 0, 1 + s});
    expect_near(animation.clips[0].frames[2][3], {0, 0, 2});
    expect_near(animation.clips[0].frames[2][1], {1, 0, 1});
}

TEST(ReadGltfAnimation, ASkinOfWhichOneJointMattersIsASequence) {
    // Joint 1 weighs 0.0005 once the weights of each vertex sum to one.
    Gltf gltf = bending_arm();
    std::vector<float> weights;
    std::vector<std::uint8_t> joints;
    for (int v = 0; v < 6; ++v) {
        weights.insert(weights.end(), {1000, .5f, 0, 0});
        joints.insert(joints.end(), {0, 1, 0, 0});
    }
    Json& attributes = gltf.json["meshes"][0]["primitives"][0]["attributes"];
    attributes["WEIGHTS_0"] = gltf.accessor(weights, "VEC4");
    attributes["JOINTS_0"] = gltf.accessor(joints, "VEC4", made_up::k_ubyte);
    EXPECT_EQ(gltf.read().kind, AnimationKind::sequence);
}

TEST(ReadGltfAnimation, FramesOfNodesAreBoundedInMemory) {
    // A mesh in 1,000 copies, in 3,600 frames, would take 130 MB from 12 kB.
    Gltf gltf = door();
    std::vector<float> places(3000, 0);
    for (std::size_t i = 0; i < places.size(); ++i) places[i] = static_cast<float>(i);
    gltf.json["nodes"][1]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
        {"TRANSLATION", gltf.accessor(places, "VEC3")}};
    gltf.json["animations"][0]["samplers"][0]["input"] = gltf.accessor<float>({0, 120}, "SCALAR");
    EXPECT_THAT(mesh_files::error_of<MeshError>([&] { std::ignore = gltf.read(30); }),
                HasSubstr("read fewer frames per second"));
}

TEST(ReadGltfAnimation, MorphTargetsHaveNamesWeightsAndClips) {
    Gltf gltf = face({"open", "", "smile"});
    gltf.json["meshes"][0]["weights"] = {0.5, 0, 0.25};
    gltf.json["animations"] = Json::array({{{"name", "talk"}}});
    gltf.channel(0, 0, "weights", {0, 1}, gltf.accessor<float>({0, 0, 1, 1, 0, 0}, "SCALAR"));
    Animation animation = gltf.read(2);
    EXPECT_EQ(animation.kind, AnimationKind::blend_shapes);
    ASSERT_THAT(animation.rig.targets, SizeIs(3));
    EXPECT_EQ(animation.rig.targets[0].name, "open");
    EXPECT_EQ(animation.rig.targets[1].name, "target_1");
    EXPECT_EQ(animation.rig.targets[2].name, "smile");
    EXPECT_THAT(rest_pose(animation.rig).weights, ElementsAre(0.5f, 0, 0.25f));
    ASSERT_THAT(animation.clips.at(0).poses, SizeIs(3));
    EXPECT_THAT(animation.clips[0].poses[1].weights, ElementsAre(0.5f, 0, 0.5f));
    expect_near(frame_vertices(animation, animation.clips[0], 1)[0], {0, 0, 0.5f});
    expect_near(frame_vertices(animation, animation.clips[0], 1)[2], {0, 1, 1.5f});

    gltf.json["nodes"][0]["weights"] = {0, 1, 0};
    EXPECT_THAT(rest_pose(gltf.read().rig).weights, ElementsAre(0, 1, 0));
    gltf.json["meshes"][0]["extras"].erase("targetNames");
    EXPECT_EQ(gltf.read().rig.targets[2].name, "target_2");
}

TEST(ReadGltfAnimation, SparseMorphTargetsNeedNoBufferView) {
    Gltf gltf = face({"open"});
    Json& accessor = gltf.json["accessors"][1];
    accessor.erase("bufferView");
    accessor["sparse"] = {
        {"count", 1},
        {"indices", {{"bufferView", gltf.view<std::uint16_t>({2, 0})}, {"componentType", made_up::k_ushort}}},
        {"values", {{"bufferView", gltf.view<float>({7, 8, 9})}}}};
    const MorphTarget target = gltf.read().rig.targets.at(0);
    EXPECT_THAT(target.vertices, ElementsAre(2));
    EXPECT_THAT(target.offsets, ElementsAre(Vec3(7, 8, 9)));
}

TEST(ReadGltfAnimation, MorphTargetsWithoutBufferViewMoveNothing) {
    Gltf gltf = face({"open", "nothing"});
    gltf.json["accessors"][2].erase("bufferView");
    const Animation animation = gltf.read();
    ASSERT_THAT(animation.rig.targets, SizeIs(2));
    EXPECT_THAT(animation.rig.targets[0].vertices, SizeIs(1));
    EXPECT_THAT(animation.rig.targets[1].vertices, IsEmpty());
}

TEST(ReadGltfAnimation, ASkeletonKeepsItsMorphTargets) {
    Gltf gltf = bending_arm();
    std::vector<float> offsets(18, 0);
    offsets[3 * 4 + 1] = 1;
    gltf.json["meshes"][0]["primitives"][0]["targets"] = Json::array({{{"POSITION", gltf.accessor(offsets, "VEC3")}}});
    gltf.channel(0, k_surface, "weights", {0, 1}, gltf.accessor<float>({0, 1}, "SCALAR"));
    const Animation animation = gltf.read();
    EXPECT_EQ(animation.kind, AnimationKind::skeleton);
    ASSERT_THAT(animation.rig.targets, SizeIs(1));
    expect_near(frame_vertices(animation, animation.clips[0], 30)[4], {0, 1, 0});
}

/// Two faces, at nodes 0 and 1, with a target 'open' each that opens in the clip 'talk' to `first` and to `second`.
Gltf two_faces(float first, float second) {
    Gltf gltf = face({"open"});
    gltf.json["nodes"].push_back({{"name", "lashes"}, {"mesh", 0}, {"translation", {0, 0, 5}}});
    gltf.json["animations"] = Json::array({{{"name", "talk"}}});
    gltf.channel(0, 0, "weights", {0, 1}, gltf.accessor<float>({0, first}, "SCALAR"));
    gltf.channel(0, 1, "weights", {0, 1}, gltf.accessor<float>({0, second}, "SCALAR"));
    return gltf;
}

TEST(ReadGltfAnimation, TargetsOfOneNameAndWeightAreOneTarget) {
    const Animation together = two_faces(1, 1).read(1);
    ASSERT_THAT(together.rig.targets, SizeIs(1));
    EXPECT_THAT(together.rig.targets[0].vertices, ElementsAre(0, 3));
    EXPECT_THAT(together.clips.at(0).poses.at(1).weights, ElementsAre(1));
    const Animation apart = two_faces(1, 0.5f).read(1);
    ASSERT_THAT(apart.rig.targets, SizeIs(2));
    EXPECT_EQ(apart.rig.targets[0].name, "open");
    EXPECT_EQ(apart.rig.targets[1].name, "open (2)");
    EXPECT_THAT(apart.clips.at(0).poses.at(1).weights, ElementsAre(1, 0.5f));
    Gltf unnamed = two_faces(1, 1);
    unnamed.json["meshes"][0].erase("extras");
    EXPECT_THAT(unnamed.read(1).rig.targets, SizeIs(2));
}

/// An arm with a clip for each joint, which end at the given times.
Gltf takes(const std::string& first, const std::string& second, float first_end, float second_end,
           std::size_t second_node = k_lower) {
    Gltf gltf = arm();
    gltf.json["animations"] = Json::array({{{"name", first}}, {{"name", second}}});
    gltf.channel(0, k_upper, "translation", {0, first_end}, gltf.accessor<float>({0, 0, 0, 1, 0, 0}, "VEC3"));
    gltf.channel(1, second_node, "translation", {0, second_end}, gltf.accessor<float>({0, 0, 0, 0, 1, 0}, "VEC3"));
    return gltf;
}

TEST(ReadGltfAnimation, AnimationsOfOneTakeAreMerged) {
    const Animation animation = takes("hip|Take 001|Base", "knee|Take 001|Base", 1, 1).read(1);
    ASSERT_THAT(animation.clips, SizeIs(1));
    EXPECT_EQ(animation.clips[0].name, "Take 001|Base");
    EXPECT_THAT(warnings_of(animation), HasSubstr("2 animations of the take 'Take 001|Base' were merged"));
    expect_near(animation.clips[0].poses.at(1).nodes[0].translation, {1, 0, 0});
    expect_near(animation.clips[0].poses.at(1).nodes[1].translation, {0, 1, 0});
}

TEST(ReadGltfAnimation, OtherAnimationsStayApart) {
    EXPECT_THAT(takes("hip|walk", "knee|run", 1, 1).read().clips, SizeIs(2));
    EXPECT_THAT(takes("hip|walk", "knee|walk", 1, 2).read().clips, SizeIs(2));
    EXPECT_THAT(takes("walk", "walk", 1, 1).read().clips, SizeIs(2));
    const Animation animation = takes("hip|walk", "hip|walk", 1, 1, k_upper).read();
    ASSERT_THAT(animation.clips, SizeIs(2));
    EXPECT_EQ(animation.clips[0].name, "hip|walk");
    EXPECT_EQ(animation.clips[1].name, "hip|walk (2)");
}

TEST(ReadGltfAnimation, OneKeyIsOneFrame) {
    EXPECT_THAT(sampled("LINEAR", {5}, {3}, 30), ElementsAre(3));
    EXPECT_THAT(sampled("LINEAR", {0}, {3}, 30), ElementsAre(3));
}

TEST(ReadGltfAnimation, WhatMovesOnlyOtherThingsIsNoClip) {
    Gltf gltf = bending_arm();
    gltf.json["nodes"].push_back({{"name", "camera"}});
    gltf.json["animations"].push_back({{"name", "flight"}});
    gltf.channel(1, 3, "translation", {0, 1}, gltf.accessor<float>({0, 0, 0, 1, 0, 0}, "VEC3"));
    const Animation animation = gltf.read();
    EXPECT_THAT(animation.clips, SizeIs(1));
    EXPECT_THAT(warnings_of(animation), HasSubstr("the clip 'flight' moves nothing"));
}

TEST(ReadGltfAnimation, JointsOfNoWeightAreNotLookedUp) {
    Gltf gltf = arm();
    gltf.json["meshes"][0]["primitives"][0]["attributes"]["JOINTS_0"] = gltf.accessor<std::uint8_t>(
        {0, 9, 9, 9, 0, 9, 9, 9, 0, 1, 9, 9, 0, 1, 9, 9, 1, 9, 9, 9, 1, 9, 9, 9}, "VEC4", made_up::k_ubyte);
    EXPECT_THAT(gltf.read().warnings, IsEmpty());
}

TEST(ReadGltfAnimation, VerticesWithoutWeightHangOnTheFirstJoint) {
    Gltf gltf = arm();
    gltf.json["meshes"][0]["primitives"][0]["attributes"]["WEIGHTS_0"] =
        gltf.accessor<float>({1, 0, 0, 0, 1, 0, 0, 0, .5f, .5f, 0, 0, .5f, .5f, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0}, "VEC4");
    const Animation animation = gltf.read();
    ASSERT_THAT(animation.rig.influences_of(5), SizeIs(1));
    EXPECT_EQ(animation.rig.nodes[animation.rig.bones[animation.rig.influences_of(5)[0].bone].node].name, "upper");
    EXPECT_THAT(animation.warnings, ElementsAre(HasSubstr("1 vertices have no weight")));
}

TEST(ReadGltfAnimation, BrokenFramesAreDropped) {
    Gltf gltf = arm();
    gltf.json["animations"] = Json::array({{{"name", "jump"}}});
    const float nan = std::numeric_limits<float>::quiet_NaN();
    gltf.channel(0, k_lower, "translation", {0, 1, 2}, gltf.accessor<float>({1, 0, 0, nan, 0, 0, 2, 0, 0}, "VEC3"),
                 "STEP");
    const Animation animation = gltf.read(2);
    EXPECT_THAT(animation.clips.at(0).poses, SizeIs(3));
    EXPECT_THAT(warnings_of(animation), HasSubstr("clip 'jump': frames 2, 3 are not finite"));
}

}  // namespace
}  // namespace exemplar
