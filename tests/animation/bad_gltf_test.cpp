#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "host/core/errors.h"
#include "tests/animation/made_up_gltf.h"

namespace exemplar {
namespace {

using made_up::bending_arm;
using made_up::face;
using made_up::Gltf;
using made_up::Json;
using made_up::k_lower;
using made_up::k_surface;
using made_up::k_upper;
using testing::HasSubstr;
using testing::Not;

std::string error_of(const Gltf& gltf, double frames_per_second = 30) {
    std::string message = mesh_files::error_of<MeshError>([&] { std::ignore = gltf.read(frames_per_second); });
    EXPECT_THAT(message, HasSubstr("a.glb: "));
    EXPECT_THAT(message, Not(HasSubstr("\n")));
    return message;
}

/// What is said of the bending arm after `damage` to it.
template <typename Damage>
std::string gltf_error_after(Damage&& damage) {
    Gltf gltf = bending_arm();
    damage(gltf, gltf.json);
    return error_of(gltf);
}

TEST(BadGltfAnimation, NodesThatFormNoTree) {
    EXPECT_THAT(gltf_error_after([](Gltf&, Json& json) { json["nodes"][k_lower]["children"] = {k_upper}; }),
                HasSubstr("its own ancestor"));
    EXPECT_THAT(gltf_error_after([](Gltf&, Json& json) { json["nodes"][k_surface]["children"] = {k_lower}; }),
                HasSubstr("two parents"));
    EXPECT_THAT(gltf_error_after([](Gltf&, Json& json) { json["nodes"][k_lower]["children"] = {7}; }),
                HasSubstr("node 7 is named, but there are 3"));
    EXPECT_THAT(gltf_error_after([](Gltf&, Json& json) { json["scenes"][0]["nodes"] = {-2}; }), HasSubstr("node -2"));
    EXPECT_THAT(gltf_error_after([](Gltf&, Json& json) {
                    json["nodes"][k_upper]["rotation"] = {1, 2};
                }),
                HasSubstr("rotation of 2 numbers"));
    EXPECT_THAT(gltf_error_after([](Gltf&, Json& json) {
                    json["nodes"][k_upper]["scale"] = {1e300, 1, 1};
                }),
                HasSubstr("('upper') is not finite"));
}

TEST(BadGltfAnimation, SkinsThatDoNotFit) {
    EXPECT_THAT(gltf_error_after([](Gltf&, Json& json) { json["nodes"][k_surface]["skin"] = 1; }), HasSubstr("skin 1"));
    EXPECT_THAT(gltf_error_after([](Gltf&, Json& json) {
                    json["skins"][0]["joints"] = {1, 0, 2};
                }),
                HasSubstr("2 inverse bind matrices for 3 joints"));
    EXPECT_THAT(gltf_error_after([](Gltf&, Json& json) { json["skins"][0]["joints"] = {1}; }),
                HasSubstr("joint 1 is named, but skin 0 has 1"));
    EXPECT_THAT(gltf_error_after([](Gltf&, Json& json) { json["skins"][0]["joints"] = {1, 5}; }), HasSubstr("node 5"));
    EXPECT_THAT(gltf_error_after([](Gltf&, Json& json) { json["skins"][0]["joints"] = Json::array(); }),
                HasSubstr("no joints"));
    const auto attributes = [](Json& json) -> Json& { return json["meshes"][0]["primitives"][0]["attributes"]; };
    EXPECT_THAT(gltf_error_after([&](Gltf&, Json& json) { attributes(json).erase("WEIGHTS_0"); }),
                HasSubstr("JOINTS_0 without WEIGHTS_0"));
    EXPECT_THAT(gltf_error_after([&](Gltf& gltf, Json& json) {
                    attributes(json)["WEIGHTS_0"] = gltf.accessor<float>({1, 0, 0, 0}, "VEC4");
                }),
                HasSubstr("weights for 1 of 6 vertices"));
    EXPECT_THAT(gltf_error_after([&](Gltf& gltf, Json& json) {
                    std::vector<float> weights(24, std::numeric_limits<float>::quiet_NaN());
                    attributes(json)["WEIGHTS_0"] = gltf.accessor(weights, "VEC4");
                }),
                HasSubstr("vertex 0 has a weight that is not finite"));
    EXPECT_THAT(gltf_error_after([&](Gltf& gltf, Json& json) {
                    std::vector<float> positions(18, std::numeric_limits<float>::infinity());
                    attributes(json)["POSITION"] = gltf.accessor(positions, "VEC3");
                }),
                HasSubstr("vertex 0 of the rest shape is not finite"));
}

TEST(BadGltfAnimation, KeysThatDoNotFit) {
    const auto sampler = [](Json& json) -> Json& { return json["animations"][0]["samplers"][0]; };
    EXPECT_THAT(gltf_error_after([&](Gltf& gltf, Json& json) {
                    sampler(json)["input"] = gltf.accessor<float>({1, 0.5f}, "SCALAR");
                }),
                HasSubstr("key 1 is before key 0"));
    EXPECT_THAT(
        gltf_error_after([&](Gltf& gltf, Json& json) {
            sampler(json)["input"] = gltf.accessor<float>({0, std::numeric_limits<float>::infinity()}, "SCALAR");
        }),
        HasSubstr("the time of key 1 is not finite"));
    EXPECT_THAT(gltf_error_after([&](Gltf& gltf, Json& json) {
                    sampler(json)["input"] = gltf.accessor<float>({0, 1, 2}, "SCALAR");
                }),
                HasSubstr("3 keys need 12 numbers"));
    EXPECT_THAT(gltf_error_after([&](Gltf&, Json& json) { sampler(json)["interpolation"] = "CUBICSPLINE"; }),
                HasSubstr("2 keys need 24 numbers"));
    EXPECT_THAT(gltf_error_after([&](Gltf&, Json& json) { sampler(json)["output"] = 99; }), HasSubstr("accessor 99"));
    EXPECT_THAT(gltf_error_after([&](Gltf&, Json& json) { json["animations"][0]["channels"][0]["sampler"] = 4; }),
                HasSubstr("sampler 4 is named, but there are 1"));
    EXPECT_THAT(
        gltf_error_after([&](Gltf&, Json& json) { json["animations"][0]["channels"][0]["target"]["node"] = 9; }),
        HasSubstr("node 9"));
    EXPECT_THAT(gltf_error_after([&](Gltf& gltf, Json& json) {
                    sampler(json)["input"] = gltf.accessor<float>({0, 1e9f}, "SCALAR");
                }),
                HasSubstr("read fewer frames per second"));
    EXPECT_THAT(gltf_error_after([&](Gltf& gltf, Json& json) {
                    sampler(json)["output"] = gltf.accessor(std::vector<float>(8, NAN), "VEC4");
                }),
                HasSubstr("clip 'bend': no frame is finite"));
}

TEST(BadGltfAnimation, MorphTargetsThatDoNotFit) {
    Gltf gltf = face({"open"});
    gltf.json["nodes"][0]["weights"] = {1, 2};
    EXPECT_THAT(error_of(gltf), HasSubstr("2 weights for 1 morph targets"));
    gltf = face({"open"});
    gltf.json["meshes"][0]["primitives"][0]["targets"][0]["POSITION"] = gltf.accessor<float>({0, 0, 1}, "VEC3");
    EXPECT_THAT(error_of(gltf), HasSubstr("morph target 'open' moves 1 vertices of 3"));
}

TEST(BadGltfAnimation, NothingThatMoves) {
    EXPECT_THAT(error_of(face({})), HasSubstr("neither a skin of several joints nor a morph target"));
    EXPECT_THAT(gltf_error_after([&](Gltf&, Json& json) { json["scenes"][0]["nodes"] = {k_upper}; }),
                HasSubstr("no node of its scene has a mesh"));
    EXPECT_THROW(std::ignore = bending_arm().read(0), UsageError);
    EXPECT_THROW(std::ignore = bending_arm().read(NAN), UsageError);
}

}  // namespace
}  // namespace exemplar
