#include "host/animation/read_surface.h"

#include <gmock/gmock.h>

#include "host/core/errors.h"
#include "host/mesh/io/io.h"
#include "tests/animation/made_up_gltf.h"
#include "tests/support/shapes.h"
#include "tests/support/temporary_folder.h"

namespace exemplar {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

TEST(ReadSurface, AMeshIsADrawableSequenceWithoutClips) {
    const TemporaryFolder folder;
    TriangleMesh mesh = shapes::box(1, 1, 1, 2);
    const std::size_t places = mesh.vertex_count();
    mesh.vertices.push_back(mesh.vertices[mesh.faces[0][0]]);
    mesh.faces[0][0] = static_cast<std::uint32_t>(places);
    write_off(folder / "box.off", mesh);
    const SurfaceFile file = read_surface(folder / "box.off");
    EXPECT_FALSE(file.animation.moves());
    EXPECT_FALSE(file.animation.has_rig());
    EXPECT_EQ(file.animation.rest.vertex_count(), places);
    EXPECT_EQ(vertices_of(file.animation, shape_at(file.animation, 0, 0)), file.animation.rest.vertices);
    EXPECT_THAT(file.why_still, IsEmpty());
}

TEST(ReadSurface, AGltfFileIsAnAnimationIfItMoves) {
    const TemporaryFolder folder;
    const made_up::Gltf moving = made_up::bending_arm(), still = made_up::face({});
    mesh_files::write_bytes(folder / "moving.GLB", moving.bytes());
    mesh_files::write_bytes(folder / "still.glb", still.bytes());
    const SurfaceFile animation = read_surface(folder / "moving.GLB"), mesh = read_surface(folder / "still.glb");
    EXPECT_TRUE(animation.animation.moves());
    const SurfaceShape shape = shape_at(animation.animation, 0, 30);
    ASSERT_TRUE(shape.pose);
    EXPECT_EQ(vertices_of(animation.animation, shape),
              frame_vertices(animation.animation, animation.animation.clips[0], 30));
    EXPECT_FALSE(mesh.animation.moves());
    EXPECT_THAT(mesh.animation.rest.faces, SizeIs(1));
    EXPECT_THAT(mesh.why_still, HasSubstr("neither a skin"));
}

TEST(ReadSurface, AnAnimationThatCannotBeReadIsTold) {
    const TemporaryFolder folder;
    const auto read = [&](const made_up::Gltf& gltf) {
        mesh_files::write_bytes(folder / "a.glb", gltf.bytes());
        return read_surface(folder / "a.glb").animation;
    };
    made_up::Gltf few = made_up::bending_arm();
    few.json["animations"][0]["samplers"][0]["input"] = few.accessor<float>({0, 1, 2}, "SCALAR");
    const Animation still = read(few);
    EXPECT_FALSE(still.moves());
    EXPECT_THAT(still.rest.faces, SizeIs(4));
    EXPECT_THAT(made_up::warnings_of(still),
                testing::AllOf(HasSubstr("shown as a still"), HasSubstr("clip 'bend', accessor"),
                               HasSubstr("3 keys need 12 numbers"), testing::Not(HasSubstr("a.glb"))));
    // Nothing of the surface follows the camera.
    made_up::Gltf camera = made_up::face({});
    camera.json["nodes"].push_back({{"name", "camera"}});
    camera.json["animations"] = made_up::Json::array({{{"name", "flight"}}});
    camera.channel(0, 1, "translation", {0, 1}, camera.accessor<float>({0, 0, 0, 1, 0, 0}, "VEC3"));
    EXPECT_THAT(made_up::warnings_of(read(camera)), HasSubstr("none of its 1 animations moves a node of the surface"));
    EXPECT_THAT(read(made_up::face({})).warnings, IsEmpty());
}

TEST(ReadSurface, AFolderIsAnAnimationOrRefused) {
    const TemporaryFolder folder;
    EXPECT_THROW(read_surface(folder.path()), MeshError);
    const TriangleMesh mesh = shapes::box(1, 1, 1, 2);
    for (const char* name : {"1.off", "2.off"}) write_off(folder / name, mesh);
    EXPECT_EQ(read_surface(folder.path()).animation.frame_count(), 2u);
    EXPECT_THROW(read_surface(folder / "3.off"), DataError);
}

}  // namespace
}  // namespace exemplar
