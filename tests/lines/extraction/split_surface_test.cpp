#include "host/lines/extraction/split_surface.h"

#include <gtest/gtest.h>

#include <set>

#include "host/core/errors.h"
#include "tests/support/shapes.h"

namespace exemplar {
namespace {

SplitSurface split(const TriangleMesh& mesh, float angle) {
    return split_at_creases(mesh.faces, mesh.vertices, build_face_neighbors(mesh.faces, mesh.vertex_count()), angle);
}

void expect_same_places(const TriangleMesh& mesh, const SplitSurface& surface) {
    ASSERT_EQ(surface.faces.size(), mesh.face_count());
    for (std::size_t f = 0; f < mesh.face_count(); ++f)
        for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(surface.source[surface.faces[f][i]], mesh.faces[f][i]);
    const std::vector<Vec3> at = surface.positions(mesh.vertices);
    for (std::size_t v = 0; v < at.size(); ++v) EXPECT_EQ(at[v], mesh.vertices[surface.source[v]]);
}

TEST(SplitSurfaces, OfACubeAreSixSquares) {
    const TriangleMesh mesh = shapes::box(1, 1, 1, 3);
    const SplitSurface surface = split(mesh, 0.7f);
    expect_same_places(mesh, surface);
    EXPECT_EQ(surface.source.size(), 6 * 16);
    EXPECT_EQ(split(mesh, 1.6f).source.size(), mesh.vertex_count());
}

TEST(SplitSurfaces, OfSmoothOnesAreTheSame) {
    for (const TriangleMesh& mesh : {shapes::icosphere(3, 1), shapes::torus(3, 1, 40, 20)}) {
        const SplitSurface surface = split(mesh, 0.7f);
        expect_same_places(mesh, surface);
        EXPECT_EQ(surface.source.size(), mesh.vertex_count());
    }
}

TEST(SplitSurfaces, StayWholeWhereACreaseEnds) {
    // Around an inner end of a crease there is a way past it.
    TriangleMesh mesh = shapes::grid(4, 4, 4);
    for (Vec3& p : mesh.vertices)
        if (p.y() > 1.5f) p.z() = std::max(0.0f, 2 - p.x()) * std::max(0.0f, p.y() - 2);
    const SplitSurface surface = split(mesh, 0.7f);
    expect_same_places(mesh, surface);
    EXPECT_GT(surface.source.size(), mesh.vertex_count());
    EXPECT_LT(surface.source.size(), mesh.vertex_count() + 10);
}

TEST(SplitSurfaces, AreOpenAtEdgesOfThreeFaces) {
    TriangleMesh fan;
    fan.vertices = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0.5f}, {-0.5f, 0.8f, 0.5f}, {-0.5f, -0.8f, 0.5f}};
    fan.faces = {{0, 1, 2}, {0, 1, 3}, {1, 0, 4}};
    EXPECT_EQ(split(fan, 3.1f).source.size(), 9);
}

TEST(SplitSurfaces, RefuseWhatDoesNotFit) {
    const TriangleMesh mesh = shapes::grid(1, 1, 1);
    auto neighbors = build_face_neighbors(mesh.faces, mesh.vertex_count());
    EXPECT_THROW(split_at_creases(mesh.faces, std::span(mesh.vertices).first(2), neighbors, 1), MeshError);
    neighbors[0][2] = 4 * 7;
    EXPECT_THROW(split_at_creases(mesh.faces, mesh.vertices, neighbors, 1), UsageError);
    neighbors.pop_back();
    EXPECT_THROW(split_at_creases(mesh.faces, mesh.vertices, neighbors, 1), UsageError);
}

}  // namespace
}  // namespace exemplar
