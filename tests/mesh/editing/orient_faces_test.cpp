#include "host/mesh/editing/orient_faces.h"

#include <gtest/gtest.h>

#include <numbers>
#include <utility>
#include <vector>

#include "host/core/random.h"
#include "host/mesh/editing/weld.h"
#include "tests/support/shapes.h"

namespace exemplar {
namespace {

void turn(Face& face) {
    std::swap(face[1], face[2]);
}
TriangleMesh turned_around(TriangleMesh mesh) {
    for (Face& face : mesh.faces) turn(face);
    return mesh;
}
TriangleMesh oriented(TriangleMesh mesh) {
    orient_faces(mesh);
    return mesh;
}
TriangleMesh lone_triangle(const Vec3& at) {
    TriangleMesh mesh;
    mesh.vertices = {at, at + Vec3::UnitX(), at + Vec3::UnitY()};
    mesh.faces = {{0, 1, 2}};
    mesh.source_face_count = 1;
    return mesh;
}
/// A band of `n` quads with half a twist; its last quad is joined to its first, turned over.
TriangleMesh moebius_strip(std::uint32_t n) {
    TriangleMesh mesh;
    for (std::uint32_t i = 0; i < n; ++i) {
        const double u = 2 * std::numbers::pi * i / n;
        for (const double s : {-0.3, 0.3}) {
            const double r = 1 + s * std::cos(u / 2);
            mesh.vertices.push_back(shapes::detail::vec3(r * std::cos(u), r * std::sin(u), s * std::sin(u / 2)));
        }
    }
    for (std::uint32_t i = 0; i < n; ++i) {
        const std::uint32_t a = 2 * i, b = a + 1;
        const std::uint32_t c = i + 1 < n ? a + 3 : 0, d = i + 1 < n ? a + 2 : 1;
        shapes::detail::add_quad(mesh, a, b, c, d);
    }
    return shapes::detail::finished(std::move(mesh));
}

TEST(OrientFaces, LeavesOrdinarySurfacesAsTheyAre) {
    for (const TriangleMesh& mesh :
         {shapes::torus(2, 0.5f, 16, 8), shapes::box(1, 2, 3, 2), shapes::grid(3, 3, 1), moebius_strip(12),
          turned_around(shapes::grid(3, 3, 1)), shapes::cylinder(1, 4, 12, 4, false),
          shapes::joined(shapes::icosphere(2, 1), shapes::translated(shapes::icosphere(1, 1), {3, 0, 0}))}) {
        TriangleMesh same = mesh;
        const OrientationChange change = orient_faces(same);
        EXPECT_EQ(change.turned_faces, 0);
        EXPECT_EQ(change.turned_pieces, 0);
        EXPECT_EQ(same.faces, mesh.faces);
    }
}

TEST(OrientFaces, TurnsAPieceThatIsInsideOutBesideOthers) {
    const TriangleMesh ball = shapes::icosphere(2, 1), other = shapes::translated(ball, {3, 0, 0}),
                       open = lone_triangle({0, 5, 0});
    const TriangleMesh right = shapes::joined(shapes::joined(ball, other), open);
    TriangleMesh mesh = shapes::joined(shapes::joined(turned_around(ball), other), open);
    const OrientationChange change = orient_faces(mesh);
    EXPECT_EQ(change.pieces, 3);
    EXPECT_EQ(change.turned_pieces, 1);
    EXPECT_EQ(change.turned_faces, 0);
    EXPECT_EQ(mesh.faces, right.faces);
}

TEST(OrientFaces, TurnsFacesToAgreeWithMostOfTheirPiece) {
    for (const TriangleMesh& right : {shapes::torus(2, 0.5f, 16, 8), shapes::grid(6, 6, 1)}) {
        TriangleMesh mesh = right;
        Random random(3);
        std::size_t turned = 0;
        for (std::size_t f = 0; f < mesh.face_count(); ++f) {
            if (random.uniform() > 0.3) continue;
            turn(mesh.faces[f]);
            ++turned;
        }
        const OrientationChange change = orient_faces(mesh);
        EXPECT_EQ(change.turned_faces, turned);
        EXPECT_EQ(change.turned_pieces, 0);
        EXPECT_EQ(mesh.faces, right.faces);
    }
}

TEST(OrientFaces, KeepsTheOrientationOfOpenSheets) {
    // A bowl may be meant to be seen from either side.
    TriangleMesh bowl = shapes::icosphere(3, 1);
    std::erase_if(bowl.faces, [&](const Face& face) { return bowl.vertices[face[0]].z() > 0; });
    EXPECT_EQ(oriented(bowl).faces, bowl.faces);
    EXPECT_EQ(oriented(turned_around(bowl)).faces, turned_around(bowl).faces);
}

TEST(OrientFaces, TurnsASurfaceWithASmallHoleOutward) {
    TriangleMesh ball = shapes::translated(shapes::icosphere(2, 1), {1000, 0, 0});
    ball.faces.resize(ball.face_count() - 10);
    EXPECT_EQ(oriented(turned_around(ball)).faces, ball.faces);
}

TEST(OrientFaces, KeepsCavities) {
    const TriangleMesh outer = shapes::icosphere(2, 3), inner = shapes::icosphere(2, 2), core = shapes::icosphere(1, 1);
    const TriangleMesh shell = shapes::joined(outer, turned_around(inner));
    const TriangleMesh shell_and_core = shapes::joined(shell, core), solid_in_solid = shapes::joined(outer, inner);
    const TriangleMesh boxes = shapes::joined(shapes::box(4, 4, 4, 1), turned_around(shapes::box(2, 2, 2, 1)));
    for (const TriangleMesh& right : {shell, shell_and_core, solid_in_solid, boxes})
        EXPECT_EQ(oriented(right).faces, right.faces);
    EXPECT_EQ(oriented(turned_around(solid_in_solid)).faces, solid_in_solid.faces);
    // A piece beside another is no cavity of it, however their boxes lie.
    const TriangleMesh beside = shapes::joined(shapes::torus(2, 0.5f, 24, 12), turned_around(core));
    EXPECT_EQ(oriented(beside).faces, shapes::joined(shapes::torus(2, 0.5f, 24, 12), core).faces);
}

TEST(OrientFaces, TurnsARoomButNotWhatStandsInIt) {
    const TriangleMesh room = shapes::box(4, 4, 4, 1),
                       chair = shapes::translated(shapes::box(1, 1, 1, 1), {0, 0, -1.5f});
    EXPECT_EQ(oriented(shapes::joined(turned_around(room), chair)).faces, shapes::joined(room, chair).faces);
}

TEST(OrientFaces, LeavesOneSeamOfAMoebiusStrip) {
    const TriangleMesh strip = moebius_strip(12);
    TriangleMesh mesh = strip;
    for (const std::size_t f : {3, 8, 9, 15}) turn(mesh.faces[f]);
    const OrientationChange change = orient_faces(mesh);
    EXPECT_GT(change.turned_faces, 0);
    EXPECT_EQ(change.turned_pieces, 0);
    const TriangleMesh once = mesh;
    EXPECT_EQ(orient_faces(mesh).turned_faces, 0);
    EXPECT_EQ(mesh.faces, once.faces);
}

TEST(OrientFaces, TurnsAClosedSurfaceOfManyPatchesAsAWhole) {
    // Blocks along a diagonal meet at edges of four faces.
    TriangleMesh mesh;
    for (int i = 0; i < 3; ++i)
        mesh = shapes::joined(
            mesh, shapes::translated(shapes::box(1, 1, 1, 1), {static_cast<float>(i), static_cast<float>(i), 0}));
    EXPECT_EQ(oriented(turned_around(mesh)).faces, mesh.faces);
}

TEST(OrientFaces, DoesNotDependOnTheOrderOfFaces) {
    TriangleMesh mesh = shapes::joined(shapes::icosphere(2, 1), shapes::translated(shapes::icosphere(2, 1), {3, 0, 0}));
    Random random(5);
    for (Face& face : mesh.faces)
        if (random.uniform() < 0.7) turn(face);
    const TriangleMesh once = oriented(mesh);
    std::vector<std::uint32_t> order;
    const TriangleMesh shuffled = oriented(shapes::with_shuffled_faces(mesh, 2, &order));
    for (std::size_t i = 0; i < order.size(); ++i) EXPECT_EQ(shuffled.faces[i], once.faces[order[i]]);
    EXPECT_EQ(oriented(once).faces, once.faces);
}

}  // namespace
}  // namespace exemplar
