#include "host/lines/extraction/split_surface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "host/core/errors.h"
#include "tests/support/shapes.h"

namespace exemplar {
namespace {

std::vector<FaceNeighbors> marked(const TriangleMesh& mesh, float angle) {
    std::vector<FaceNeighbors> neighbors = build_face_neighbors(mesh.faces, mesh.vertices);
    mark_sharp_edges(mesh.faces, mesh.vertices, angle, neighbors);
    return neighbors;
}

SplitSurface split(const TriangleMesh& mesh, float angle) {
    return split_at_sharp_edges(mesh.faces, mesh.vertex_count(), marked(mesh, angle));
}

std::size_t count_sharp(const TriangleMesh& mesh, float angle) {
    std::size_t count = 0;
    for (const FaceNeighbors& sides : marked(mesh, angle))
        for (const std::uint32_t across : sides) count += has_neighbor(across) && (across & k_sharp_side) ? 1 : 0;
    return count / 2;
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
    for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) EXPECT_EQ(surface.source[v], v);
}

TEST(SharpEdges, AreThoseOfCoarseSurfacesToo) {
    // The sides of a regular prism are off a cylinder by 1 - cos(pi / n) radii; its diagonal is 2.24 radii.
    for (const std::uint32_t n : {6u, 12u, 18u, 40u}) {
        const TriangleMesh prism = shapes::cylinder(1, 1, n, 1, false);
        const double off = 1 - std::cos(std::numbers::pi / n);
        EXPECT_EQ(count_sharp(prism, 3), off > 0.0025 * 2.24 ? n : 0) << n;
    }
}

TEST(SharpEdges, AreNotOfFacesWithoutArea) {
    TriangleMesh mesh = shapes::grid(1, 1, 1);
    mesh.vertices.push_back(0.5f * (mesh.vertices[mesh.faces[0][0]] + mesh.vertices[mesh.faces[0][1]]));
    mesh.faces.push_back({mesh.faces[0][1], mesh.faces[0][0], 4});
    EXPECT_EQ(count_sharp(mesh, 0.1f), 0);
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
    TriangleMesh mesh = shapes::grid(32, 32, 4);
    for (Vec3& p : mesh.vertices)
        if (p.y() > 1.5f) p.z() = std::max(0.0f, 2 - p.x()) * std::max(0.0f, p.y() - 2);
    const SplitSurface surface = split(mesh, 0.7f);
    expect_same_places(mesh, surface);
    EXPECT_GT(surface.source.size(), mesh.vertex_count());
    EXPECT_LT(surface.source.size(), mesh.vertex_count() + 32);
}

TEST(SplitSurfaces, AreOpenAtEdgesOfThreeFaces) {
    TriangleMesh fan;
    fan.vertices = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0.5f}, {-0.5f, 0.8f, 0.5f}, {-0.5f, -0.8f, 0.5f}};
    fan.faces = {{0, 1, 2}, {0, 1, 3}, {1, 0, 4}};
    EXPECT_EQ(split(fan, 3.1f).source.size(), 9);
}

TEST(SplitSurfaces, RefuseWhatDoesNotFit) {
    const TriangleMesh mesh = shapes::grid(1, 1, 1);
    auto neighbors = build_face_neighbors(mesh.faces, mesh.vertices);
    EXPECT_THROW(mark_sharp_edges(mesh.faces, std::span(mesh.vertices).first(2), 1, neighbors), MeshError);
    EXPECT_THROW(split_at_sharp_edges(mesh.faces, 2, neighbors), MeshError);
    neighbors[0][2] = 4 * 7;
    EXPECT_THROW(mark_sharp_edges(mesh.faces, mesh.vertices, 1, neighbors), UsageError);
    neighbors.pop_back();
    EXPECT_THROW(mark_sharp_edges(mesh.faces, mesh.vertices, 1, neighbors), UsageError);
    EXPECT_THROW(split_at_sharp_edges(mesh.faces, mesh.vertex_count(), neighbors), UsageError);
}

}  // namespace
}  // namespace exemplar
