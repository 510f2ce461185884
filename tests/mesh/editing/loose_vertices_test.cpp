#include "host/mesh/editing/loose_vertices.h"

#include <gtest/gtest.h>

#include "tests/support/shapes.h"

namespace exemplar {
namespace {

TEST(LooseVertices, AreLeftOutAndTheSurfaceStays) {
    const TriangleMesh ball = shapes::icosphere(2, 1);
    TriangleMesh mesh = ball;
    // One before all others, and one behind them.
    mesh.vertices.insert(mesh.vertices.begin(), Vec3(100, 0, 0));
    mesh.vertices.emplace_back(0, 100, 0);
    for (Face& face : mesh.faces)
        for (std::uint32_t& v : face) ++v;
    EXPECT_EQ(vertices_of_faces(mesh).size(), ball.vertex_count());
    EXPECT_EQ(vertices_of_faces(mesh).front(), 1U);
    const TriangleMesh kept = without_loose_vertices(mesh);
    EXPECT_EQ(kept.vertices, ball.vertices);
    EXPECT_EQ(kept.faces, ball.faces);
    EXPECT_EQ(kept.source_face, ball.source_face);
}

TEST(LooseVertices, MeshesMayHaveNone) {
    const TriangleMesh ball = shapes::icosphere(1, 1);
    EXPECT_EQ(without_loose_vertices(ball).vertices, ball.vertices);
    TriangleMesh points;
    points.vertices = {Vec3(0, 0, 0), Vec3(1, 0, 0)};
    EXPECT_TRUE(without_loose_vertices(points).vertices.empty());
}

}  // namespace
}  // namespace exemplar
