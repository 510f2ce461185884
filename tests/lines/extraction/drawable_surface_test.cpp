#include "host/lines/extraction/drawable_surface.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/shapes.h"

namespace exemplar {
namespace {

TEST(DrawableSurfaces, AreCutOpenAlongTheirCreases) {
    const TriangleMesh mesh = shapes::box(1, 1, 1, 3);
    DrawableSurface cut(mesh.faces, mesh.vertices, {.crease_angle = 0.7f});
    cut.measure(mesh.vertices);
    EXPECT_EQ(cut.surface().uncut.data(), mesh.faces.data());
    EXPECT_EQ(cut.surface().vertices.size(), 6 * 16);
    for (const Vec3& normal : cut.surface().normals) EXPECT_NEAR(normal.cwiseAbs().maxCoeff(), 1, 1e-5);
}

TEST(DrawableSurfaces, AreCutButCurvatureOnlyIfItIsTold) {
    const TriangleMesh mesh = shapes::box(1, 1, 1, 3);
    const auto most_curved = [&](bool cut_curvature) {
        DrawableSurface surface(mesh.faces, mesh.vertices, {.cut_curvature = cut_curvature});
        surface.measure(mesh.vertices);
        EXPECT_EQ(surface.surface().vertices.size(), 6 * 16);
        return *std::ranges::max_element(surface.surface().curvature.k1);
    };
    EXPECT_NEAR(most_curved(true), 0, 1e-4);
    EXPECT_GT(most_curved(false), 1);
}

TEST(DrawableSurfaces, WithoutSharpEdgesStayWhole) {
    const TriangleMesh mesh = shapes::icosphere(3, 1);
    DrawableSurface surface(mesh.faces, mesh.vertices);
    surface.measure(mesh.vertices);
    EXPECT_TRUE(surface.surface().uncut.empty());
    EXPECT_EQ(surface.surface().vertices.size(), mesh.vertex_count());
}

TEST(DrawableSurfaces, AreSmoothedByTheSameWidthAsTheyGrow) {
    const TriangleMesh mesh = shapes::icosphere(3, 1);
    DrawableSurface surface(mesh.faces, mesh.vertices);
    surface.measure(mesh.vertices);
    EXPECT_NEAR(surface.surface().curvature.k1[0], 1, 0.05);
    const TriangleMesh grown = shapes::scaled(mesh, 2);
    surface.measure(grown.vertices);
    EXPECT_NEAR(surface.surface().curvature.k1[0], 0.5, 0.025);
    EXPECT_EQ(surface.surface().vertices.data(), grown.vertices.data());
}

}  // namespace
}  // namespace exemplar
