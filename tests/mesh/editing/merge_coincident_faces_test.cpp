#include "host/mesh/editing/merge_coincident_faces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "tests/support/shapes.h"

namespace exemplar {
namespace {

/// The mesh with more faces behind its own.
TriangleMesh with_more_faces(TriangleMesh mesh, const std::vector<Face>& faces) {
    mesh.faces.insert(mesh.faces.end(), faces.begin(), faces.end());
    return shapes::detail::finished(std::move(mesh));
}
/// The faces of a mesh of quads from the other side, each quad cut along its other diagonal.
std::vector<Face> backs_cut_otherwise(const TriangleMesh& quads) {
    std::vector<Face> backs;
    for (std::size_t f = 0; f < quads.face_count(); f += 2) {
        const std::uint32_t a = quads.faces[f][0], b = quads.faces[f][1], c = quads.faces[f][2],
                            d = quads.faces[f + 1][2];
        backs.push_back({b, a, d});
        backs.push_back({b, d, c});
    }
    return backs;
}

TEST(MergeCoincidentFaces, LeavesOrdinarySurfacesAsTheyAre) {
    for (const TriangleMesh& mesh : {shapes::torus(2, 0.5f, 16, 8), shapes::box(1, 2, 0.01f, 3), shapes::grid(3, 3, 1),
                                     shapes::cylinder(1, 1e-4f, 3, 1, true)}) {
        TriangleMesh same = mesh;
        EXPECT_EQ(merge_coincident_faces(same), 0);
        EXPECT_EQ(same.faces, mesh.faces);
        EXPECT_TRUE(same.source_face.empty());
    }
}

TEST(MergeCoincidentFaces, KeepsTheFirstOfFacesWithTheSameVertices) {
    const TriangleMesh ball = shapes::icosphere(2, 1);
    std::vector<Face> copies = ball.faces, backs = ball.faces;
    for (Face& face : copies) std::rotate(face.begin(), face.begin() + 1, face.end());
    for (Face& face : backs) std::swap(face[0], face[2]);
    TriangleMesh mesh = with_more_faces(with_more_faces(ball, backs), copies);
    EXPECT_EQ(merge_coincident_faces(mesh), 2 * ball.face_count());
    EXPECT_EQ(mesh.faces, ball.faces);
    EXPECT_EQ(mesh.source_of(7), 7);
    EXPECT_EQ(mesh.source_face_count, 3 * ball.face_count());
    EXPECT_EQ(merge_coincident_faces(mesh), 0);
}

TEST(MergeCoincidentFaces, KeepsOneOfTwoWaysToCutAQuad) {
    const TriangleMesh tube = shapes::torus(2, 0.5f, 32, 24);
    const TriangleMesh wave = shapes::transformed(shapes::grid(16, 16, 2), [](const Vec3& p) -> Vec3 {
        return {p.x(), p.y(), 0.2f * std::sin(3 * p.x() + p.y())};
    });
    for (const TriangleMesh& sheet : {shapes::grid(1, 1, 1), shapes::grid(4, 3, 1), wave, tube}) {
        TriangleMesh mesh = with_more_faces(sheet, backs_cut_otherwise(sheet));
        EXPECT_EQ(merge_coincident_faces(mesh), sheet.face_count());
        EXPECT_EQ(mesh.faces, sheet.faces);
    }
}

TEST(MergeCoincidentFaces, KeepsAThinTetrahedron) {
    TriangleMesh mesh;
    mesh.vertices = {{0, 0, 0}, {1, 0, 0.5f}, {1, 1, 0}, {0, 1, 0.5f}};
    mesh.faces = {{0, 1, 2}, {0, 2, 3}, {1, 0, 3}, {1, 3, 2}};
    EXPECT_EQ(merge_coincident_faces(mesh), 0);
}

}  // namespace
}  // namespace exemplar
