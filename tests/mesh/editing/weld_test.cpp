#include "host/mesh/editing/weld.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "host/mesh/editing/validate.h"
#include "tests/support/shapes.h"

namespace exemplar {
namespace {

TriangleMesh unwelded(const TriangleMesh& mesh) {
    TriangleMesh soup;
    for (const Face& face : mesh.faces) {
        const auto first = static_cast<std::uint32_t>(soup.vertex_count());
        for (const std::uint32_t v : face) soup.vertices.push_back(mesh.vertices[v]);
        soup.faces.push_back({first, first + 1, first + 2});
    }
    soup.source_face_count = static_cast<std::uint32_t>(soup.face_count());
    return soup;
}

TEST(Weld, LeavesAMeshWithoutCoincidentVerticesAsItIs) {
    TriangleMesh mesh = shapes::icosphere(2, 1.0F);
    mesh.vertices.emplace_back(9.0F, 9.0F, 9.0F);  // of no face
    const TriangleMesh same = welded(mesh);
    EXPECT_EQ(same.vertices, mesh.vertices);
    EXPECT_EQ(same.faces, mesh.faces);
}

TEST(Weld, JoinsLooseTrianglesToTheSurfaceTheyCameFrom) {
    const TriangleMesh mesh = shapes::icosphere(2, 1.0F);
    const TriangleMesh joined = welded(unwelded(mesh));
    ASSERT_EQ(joined.face_count(), mesh.face_count());
    EXPECT_EQ(joined.vertex_count(), mesh.vertex_count());
    for (std::size_t f = 0; f < mesh.face_count(); ++f)
        for (std::size_t k = 0; k < 3; ++k)
            EXPECT_EQ(joined.vertices[joined.faces[f][k]], mesh.vertices[mesh.faces[f][k]]);
    EXPECT_TRUE(validate_mesh(joined).clean());
}

TEST(Weld, KeepsPolygonsAndTakesNegativeZeroForZero) {
    TriangleMesh mesh;
    mesh.vertices = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(-0.0F, 0, -0.0F), Vec3(0, 1, 0), Vec3(1, 1, 0)};
    mesh.faces = {{0, 1, 2}, {3, 5, 4}};
    mesh.source_face = {0, 0};
    mesh.source_face_count = 1;
    const TriangleMesh joined = welded(mesh);
    EXPECT_EQ(joined.vertex_count(), 4U);
    EXPECT_EQ(joined.faces, (std::vector<Face>{{0, 1, 2}, {0, 2, 3}}));
    EXPECT_EQ(joined.source_face, mesh.source_face);
    EXPECT_EQ(joined.source_face_count, 1U);
}

}  // namespace
}  // namespace exemplar
