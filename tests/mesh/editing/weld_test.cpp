#include "host/mesh/editing/weld.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

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

/// A grid of (columns + 1) x (rows + 1) vertices at `position(u, v)`, u and v in [0, 1]: no column is joined to
/// another.
template <typename Position>
TriangleMesh sheet(std::uint32_t columns, std::uint32_t rows, const Position& position) {
    TriangleMesh mesh;
    for (std::uint32_t r = 0; r <= rows; ++r)
        for (std::uint32_t c = 0; c <= columns; ++c)
            mesh.vertices.push_back(Vec3d(position(double(c) / columns, double(r) / rows)).template cast<float>());
    for (std::uint32_t r = 0; r < rows; ++r)
        for (std::uint32_t c = 0; c < columns; ++c) {
            const std::uint32_t v = r * (columns + 1) + c, above = v + columns + 1;
            mesh.faces.push_back({v, v + 1, above + 1});
            mesh.faces.push_back({v, above + 1, above});
        }
    mesh.source_face_count = static_cast<std::uint32_t>(mesh.face_count());
    return mesh;
}

TriangleMesh tube_with_seam(std::uint32_t columns, std::uint32_t rows) {
    return sheet(columns, rows, [](double u, double v) {
        const double angle = 2 * std::numbers::pi * u;
        return Vec3d(std::cos(angle), v, std::sin(angle));
    });
}

/// Moves every coordinate by up to two units in the last place of the largest one.
TriangleMesh jittered(TriangleMesh mesh, float largest) {
    std::mt19937 random(3);
    for (Vec3& p : mesh.vertices)
        for (int i = 0; i < 3; ++i)
            p[i] += static_cast<float>(static_cast<int>(random() % 5) - 2) * std::numeric_limits<float>::epsilon() *
                    largest / 2;
    return mesh;
}

std::size_t faces_with_area(const TriangleMesh& mesh) {
    return mesh.face_count() - validate_mesh(mesh).degenerate_faces.size();
}

TEST(WeldNear, ClosesATubeWhoseLastColumnIsTheFirstButForRounding) {
    const TriangleMesh tube = tube_with_seam(24, 4);
    ASSERT_NE(tube.vertices[0], tube.vertices[24]) << "sin(2 pi) is not 0";
    const TriangleMesh joined = welded(tube);
    EXPECT_EQ(joined.vertex_count(), 24U * 5U);
    EXPECT_EQ(validate_mesh(joined).boundary_edges, 2U * 24U) << "its two ends";
    EXPECT_EQ(joined.vertices[0], tube.vertices[0]) << "the first vertex stays";
}

TEST(WeldNear, JoinsLooseTrianglesWhoseCornersWereRoundedApart) {
    for (const float size : {1e-12F, 1e-3F, 1.0F, 3e6F}) {
        const TriangleMesh ball = shapes::scaled(shapes::icosphere(3, 1), size);
        const TriangleMesh soup = jittered(unwelded(ball), size);
        const TriangleMesh joined = welded(soup);
        EXPECT_EQ(joined.vertex_count(), ball.vertex_count()) << size;
        EXPECT_TRUE(validate_mesh(joined).clean()) << size;
        EXPECT_EQ(welded(shapes::with_shuffled_faces(soup, 5)).vertex_count(), ball.vertex_count()) << size;
    }
}

TEST(WeldNear, ClosesAPoleWhoseVerticesAreACircleOfRoundings) {
    constexpr std::uint32_t k_columns = 16, k_rows = 8;
    const TriangleMesh ball = sheet(k_columns, k_rows, [](double u, double v) {
        const double longitude = 2 * std::numbers::pi * u, angle = std::numbers::pi * v;
        return Vec3d(std::sin(angle) * std::cos(longitude), std::sin(angle) * std::sin(longitude), -std::cos(angle));
    });
    const TriangleMesh joined = welded(ball);
    EXPECT_EQ(joined.vertex_count(), k_columns * (k_rows - 1) + 2U);
    EXPECT_EQ(validate_mesh(joined).boundary_edges, 0U);
    EXPECT_EQ(faces_with_area(joined), 2 * k_columns * (k_rows - 1U)) << "two of each column were needles";
}

TEST(WeldNear, KeepsWhatIsSmallBesideAFaceFarAway) {
    TriangleMesh mesh = shapes::icosphere(5, 1);  // 10,242 vertices within the rounding of the far face
    const auto far = static_cast<std::uint32_t>(mesh.vertex_count());
    for (const float x : {1e9F, 2e9F}) mesh.vertices.emplace_back(x, 0.0F, 0.0F);
    mesh.vertices.emplace_back(0.0F, 2e9F, 0.0F);
    mesh.faces.push_back({far, far + 1, far + 2});
    const TriangleMesh same = welded(mesh);
    EXPECT_EQ(same.vertices, mesh.vertices);
    EXPECT_EQ(same.faces, mesh.faces);
    const TriangleMesh tiny = shapes::joined(shapes::icosphere(2, 1), shapes::scaled(shapes::icosphere(2, 1), 1e-9F));
    EXPECT_EQ(welded(tiny).vertices, tiny.vertices);
}

TEST(WeldNear, KeepsTwoSidesThatAreFurtherApartThanRounding) {
    TriangleMesh side = shapes::grid(8, 8, 1);
    TriangleMesh other = side;
    for (Vec3& p : other.vertices) p[2] = 6e-6F;
    const TriangleMesh shell = shapes::joined(side, other);
    EXPECT_EQ(welded(shell).vertices, shell.vertices);
}

TEST(WeldNear, LeavesOutWhatIsNotFinite) {
    TriangleMesh mesh = tube_with_seam(8, 1);
    mesh.vertices.push_back(Vec3::Constant(std::numeric_limits<float>::quiet_NaN()));
    mesh.vertices.push_back(Vec3::Constant(std::numeric_limits<float>::infinity()));
    mesh.faces.push_back({0, 18, 19});
    EXPECT_EQ(welded(mesh).vertex_count(), 8U * 2U + 2U);
    for (Vec3& p : mesh.vertices) p.setZero();
    EXPECT_EQ(welded(mesh).vertex_count(), 1U);
}

}  // namespace
}  // namespace exemplar
