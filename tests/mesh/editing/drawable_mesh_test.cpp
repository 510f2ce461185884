#include "host/mesh/editing/drawable_mesh.h"

#include <gtest/gtest.h>

#include <utility>

#include "host/core/errors.h"
#include "tests/support/shapes.h"

namespace exemplar {
namespace {

TEST(DrawableMeshes, AreTurnedOutward) {
    TriangleMesh mesh = shapes::box(1, 1, 1, 2);
    EXPECT_TRUE(drawable_mesh(mesh, "box").warnings.empty());
    const TriangleMesh outward = mesh;
    for (Face& face : mesh.faces) std::swap(face[1], face[2]);
    const DrawableMesh drawable = drawable_mesh(mesh, "box");
    EXPECT_EQ(drawable.warnings.size(), 1);
    EXPECT_EQ(drawable.mesh.faces, outward.faces);
    EXPECT_THROW(drawable_mesh({}, "nothing"), MeshError);
}

TEST(DrawableMeshes, HaveOneVertexPerPlace) {
    TriangleMesh mesh = shapes::box(1, 1, 1, 2);
    const std::size_t places = mesh.vertex_count();
    mesh.vertices.push_back(mesh.vertices[mesh.faces[0][0]]);
    mesh.faces[0][0] = static_cast<std::uint32_t>(places);
    EXPECT_EQ(drawable_mesh(mesh, "box").mesh.vertex_count(), places);
}

TEST(DrawableMeshes, LackFacesWithTwoCornersAtOnePlace) {
    TriangleMesh mesh = shapes::box(1, 1, 1, 2);
    const std::vector<Face> faces = mesh.faces;
    mesh.vertices.push_back(mesh.vertices[0]);
    const auto twin = static_cast<std::uint32_t>(mesh.vertex_count() - 1);
    mesh.faces.insert(mesh.faces.begin() + 3, {0, twin, 1});
    mesh.source_face_count = static_cast<std::uint32_t>(mesh.face_count());
    const DrawableMesh drawable = drawable_mesh(mesh, "box");
    EXPECT_EQ(drawable.mesh.faces, faces);
    EXPECT_EQ(drawable.warnings.size(), 1);
    EXPECT_EQ(drawable.mesh.source_of(2), 2);
    EXPECT_EQ(drawable.mesh.source_of(3), 4);
    EXPECT_EQ(drawable.mesh.source_face_count, mesh.source_face_count);

    mesh.faces = {{0, twin, 1}};
    EXPECT_THROW(drawable_mesh(mesh, "box"), MeshError);
}

}  // namespace
}  // namespace exemplar
