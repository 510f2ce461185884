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
