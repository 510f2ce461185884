#include "host/mesh/editing/drawable_mesh.h"

#include <gmock/gmock.h>

#include <utility>
#include <vector>

#include "host/core/errors.h"
#include "host/mesh/editing/validate.h"
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

TEST(DrawableMeshes, OfOrdinaryMeshesAreEqual) {
    for (const TriangleMesh& mesh :
         {shapes::torus(2, 0.5f, 16, 8), shapes::icosphere(3, 1), shapes::box(1, 2, 3, 2), shapes::grid(3, 3, 1)}) {
        const DrawableMesh drawable = drawable_mesh(mesh, "ordinary");
        EXPECT_EQ(drawable.mesh.vertices, mesh.vertices);
        EXPECT_EQ(drawable.mesh.faces, mesh.faces);
        EXPECT_TRUE(drawable.mesh.source_face.empty());
        EXPECT_TRUE(drawable.warnings.empty());
    }
}

/// A torus from both sides, some of whose faces are turned, beside a ball that is inside out; with a face without
/// area.
TriangleMesh messy_torus() {
    TriangleMesh mesh = shapes::torus(2, 0.5f, 16, 8);
    mesh.vertices.push_back((mesh.vertices[mesh.faces[5][0]] + mesh.vertices[mesh.faces[5][1]]) / 2);
    const auto middle = static_cast<std::uint32_t>(mesh.vertex_count() - 1);
    const auto [a, b, c] = mesh.faces[5];
    mesh.faces[5] = {a, middle, c};
    mesh.faces.push_back({middle, b, c});
    mesh.faces.push_back({a, b, middle});
    for (std::size_t f = 0; f < mesh.face_count(); f += 7) std::swap(mesh.faces[f][0], mesh.faces[f][1]);
    const std::vector<Face> sides = mesh.faces;
    for (const auto& [p, q, r] : sides) mesh.faces.push_back({r, q, p});
    TriangleMesh ball = shapes::translated(shapes::icosphere(1, 1), {5, 0, 0});
    for (Face& face : ball.faces) std::swap(face[0], face[1]);
    return shapes::joined(mesh, ball);
}

TEST(DrawableMeshes, OfMessyMeshesAreCleanAndSayWhatWasDone) {
    const TriangleMesh messy = messy_torus();
    const DrawableMesh drawable = drawable_mesh(messy, "messy");
    EXPECT_THAT(drawable.warnings,
                testing::ElementsAre("1 face without area left out", "258 faces lie on others; one of each was kept",
                                     "37 faces turned around to agree with neighboring faces",
                                     "1 of 2 connected pieces was inside out; its faces were turned around"));
    const MeshReport report = validate_mesh(drawable.mesh);
    EXPECT_TRUE(report.clean());
    EXPECT_EQ(report.boundary_edges, 0);
    EXPECT_EQ(drawable.mesh.face_count(), 2 * 16 * 8 + 2 + 80);
    EXPECT_EQ(drawable.mesh.source_face.size(), drawable.mesh.face_count());
    const DrawableMesh again = drawable_mesh(drawable.mesh, "clean");
    EXPECT_EQ(again.mesh.faces, drawable.mesh.faces);
    EXPECT_EQ(again.mesh.source_face, drawable.mesh.source_face);
    EXPECT_THAT(again.warnings, testing::IsEmpty());
}

TEST(DrawableMeshes, MayHaveNoArea) {
    TriangleMesh mesh;
    mesh.vertices = {{0, 0, 0}, {1, 1, 1}, {3, 3, 3}};
    mesh.faces = {{0, 1, 2}};
    EXPECT_EQ(drawable_mesh(mesh, "a line").mesh.faces, mesh.faces);
}

}  // namespace
}  // namespace exemplar
