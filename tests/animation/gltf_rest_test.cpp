// What read_mesh makes of glTF files that pose, morph or copy their meshes: the shape that viewers show at rest.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "host/core/errors.h"
#include "host/mesh/io/io.h"
#include "tests/animation/made_up_gltf.h"

namespace exemplar {
namespace {

using made_up::arm;
using made_up::face;
using made_up::Gltf;
using made_up::Json;
using made_up::k_lower;
using made_up::k_surface;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

MeshFile still_of(const Gltf& gltf) {
    return mesh_files::read_as("a.glb", gltf.bytes());
}

void expect_places(const std::vector<Vec3>& found, const std::vector<Vec3>& expected) {
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t v = 0; v < found.size(); ++v)
        EXPECT_LT((found[v] - expected[v]).norm(), 1e-5f) << v << ": " << found[v].transpose();
}

/// Both readers see the same faces of the same vertices, in the same order.
void expect_like_animation(const Gltf& gltf) {
    const TriangleMesh mesh = still_of(gltf).mesh;
    const Animation animation = gltf.read();
    EXPECT_EQ(mesh.faces, animation.rest.faces);
    expect_places(mesh.vertices, vertices_of(animation, shape_at(animation, 0, 9999)));
}

TEST(GltfAtRest, JointsPlaceASkinAndItsOwnNodeDoesNot) {
    Gltf gltf = arm();
    gltf.json["nodes"][k_lower]["rotation"] = made_up::quarter_turn();
    const MeshFile file = still_of(gltf);
    expect_places(file.mesh.vertices, {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {.5f, .5f, 0}, {1, 1, 0}, {0, 1, 0}});
    EXPECT_THAT(file.warnings, IsEmpty());
}

TEST(GltfAtRest, StillsAndAnimationsAgree) {
    Gltf gltf = arm();
    gltf.json["nodes"][k_lower]["rotation"] = {0, 0, 0.6, 0.8};
    gltf.json["nodes"][k_lower]["scale"] = {1, 2, 1};
    expect_like_animation(gltf);
    // A second mesh, whose node is listed first although its number is larger, mirrors; its target is half open.
    std::vector<float> offsets(18, 0);
    offsets[3 * 4 + 2] = 1;
    gltf.json["meshes"].push_back(gltf.json["meshes"][0]);
    gltf.json["meshes"][1]["primitives"][0]["targets"] = Json::array({{{"POSITION", gltf.accessor(offsets, "VEC3")}}});
    gltf.json["meshes"][1]["weights"] = {0.5};
    gltf.json["nodes"].push_back({{"mesh", 1}, {"scale", {-1, 1, 1}}, {"translation", {0, 0, 7}}});
    gltf.json["scenes"][0]["nodes"] = {3, k_surface};
    expect_like_animation(gltf);
    EXPECT_EQ(still_of(gltf).mesh.vertices[4], Vec3(-2, 0, 7.5f));
}

TEST(GltfAtRest, WeightsOfNodesOverrideThoseOfMeshes) {
    Gltf gltf = face({"a", "b"});  // they move vertex 0 by 1 and vertex 1 by 2 along z
    EXPECT_EQ(still_of(gltf).mesh.vertices, (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
    gltf.json["meshes"][0]["weights"] = {0.5, 0};
    EXPECT_EQ(still_of(gltf).mesh.vertices, (std::vector<Vec3>{{0, 0, 0.5f}, {1, 0, 0}, {0, 1, 0}}));
    gltf.json["nodes"][0]["weights"] = {0, 0.25};
    EXPECT_EQ(still_of(gltf).mesh.vertices, (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0.5f}, {0, 1, 0}}));
}

/// A triangle at node 0 in three copies: in place; a quarter turn about z, 3 higher; twice as large, mirrored along x,
/// at x = 5.
Gltf copied_face() {
    Gltf gltf = face({});
    const std::vector<float> turn = made_up::quarter_turn();
    const std::size_t translation = gltf.accessor<float>({0, 0, 0, 0, 0, 3, 5, 0, 0}, "VEC3");
    const std::size_t rotation =
        gltf.accessor<float>({0, 0, 0, 1, turn[0], turn[1], turn[2], turn[3], 0, 0, 0, 1}, "VEC4");
    const std::size_t scale = gltf.accessor<float>({1, 1, 1, 1, 1, 1, -2, 2, 2}, "VEC3");
    gltf.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
        {"TRANSLATION", translation}, {"ROTATION", rotation}, {"SCALE", scale}};
    gltf.json["nodes"][0]["translation"] = {0, 0, 1};
    gltf.json["extensionsUsed"] = {"EXT_mesh_gpu_instancing"};
    return gltf;
}

TEST(GltfAtRest, InstancesAreCopies) {
    Gltf gltf = copied_face();
    for (const bool required : {false, true}) {
        if (required) gltf.json["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
        const TriangleMesh mesh = still_of(gltf).mesh;
        expect_places(
            mesh.vertices,
            {{0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {0, 0, 4}, {0, 1, 4}, {-1, 0, 4}, {5, 0, 1}, {3, 0, 1}, {5, 2, 1}});
        // The third mirrors, so that its face is turned.
        EXPECT_EQ(mesh.faces, (std::vector<Face>{{0, 1, 2}, {3, 4, 5}, {6, 8, 7}}));
    }
}

TEST(GltfAtRest, InstancesNeedAttributesOfOneLength) {
    Gltf gltf = copied_face();
    Json& attributes = gltf.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
    attributes["SCALE"] = gltf.accessor<float>({1, 1, 1}, "VEC3");
    const auto error = [&] { return mesh_files::error_of<MeshError>([&] { std::ignore = still_of(gltf); }); };
    EXPECT_THAT(error(), HasSubstr("EXT_mesh_gpu_instancing of node 0"));
    attributes = Json::object();
    EXPECT_THAT(error(), HasSubstr("EXT_mesh_gpu_instancing of node 0"));
    attributes["SCALE"] = 99;
    EXPECT_THAT(error(), HasSubstr("accessor 99"));
}

TEST(GltfAtRest, CopiesOfSkinsAreLeftOutWithAWarning) {
    Gltf gltf = arm();
    gltf.json["nodes"][k_surface]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
        {"TRANSLATION", gltf.accessor<float>({0, 0, 0, 5, 0, 0}, "VEC3")}};
    const MeshFile file = still_of(gltf);
    EXPECT_THAT(file.mesh.faces, SizeIs(4));
    EXPECT_THAT(file.warnings, testing::ElementsAre(HasSubstr("copies of skinned meshes")));
}

TEST(GltfAtRest, ASceneWithoutMeshesIsRefused) {
    Gltf gltf = face({});
    gltf.json["nodes"] = Json::array({{{"name", "empty"}}});
    EXPECT_THAT(mesh_files::error_of<MeshError>([&] { std::ignore = still_of(gltf); }),
                HasSubstr("no node of its scene has a mesh"));
}

}  // namespace
}  // namespace exemplar
