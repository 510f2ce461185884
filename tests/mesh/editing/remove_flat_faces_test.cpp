#include "host/mesh/editing/remove_flat_faces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "host/core/random.h"
#include "host/mesh/editing/area_vector.h"
#include "host/mesh/editing/validate.h"
#include "tests/support/shapes.h"

namespace exemplar {
namespace {

/// Puts a vertex on a side of face f, at this share of its length: the face is cut there, and a face without area
/// fills the gap to the face across.
void add_flat_face(TriangleMesh& mesh, std::size_t f, std::size_t side, float share) {
    const Face face = mesh.faces[f];
    const std::uint32_t a = face[side], b = face[(side + 1) % 3], d = face[(side + 2) % 3],
                        c = shapes::detail::index_of(mesh.vertex_count());
    mesh.vertices.push_back((1 - share) * mesh.vertices[a] + share * mesh.vertices[b]);
    mesh.faces[f] = {a, c, d};
    mesh.faces.push_back({c, b, d});
    mesh.faces.push_back({a, b, c});
    mesh.source_face_count = shapes::detail::index_of(mesh.face_count());
}
TriangleMesh with_flat_faces(TriangleMesh mesh, std::size_t count, std::uint64_t seed) {
    Random random(seed);
    for (std::size_t i = 0; i < count; ++i)
        add_flat_face(mesh, random.index(mesh.face_count()), random.index(3),
                      static_cast<float>(random.uniform(0.2, 0.8)));
    return mesh;
}
double volume_of(const TriangleMesh& mesh) {
    double volume = 0;
    for (const Face& face : mesh.faces)
        volume += doubled_area_vector(mesh, face).dot(mesh.vertices[face[0]].cast<double>()) / 6;
    return volume;
}
/// The faces in a form that depends neither on their order nor on their first corners.
std::vector<Face> in_order(std::vector<Face> faces) {
    for (Face& face : faces) std::rotate(face.begin(), std::ranges::min_element(face), face.end());
    std::ranges::sort(faces);
    return faces;
}

TEST(RemoveFlatFaces, LeavesOrdinarySurfacesAsTheyAre) {
    for (const TriangleMesh& mesh :
         {shapes::torus(2, 0.5f, 16, 8), shapes::cylinder(1, 1e-3f, 60, 1, true),
          shapes::scaled(shapes::icosphere(2, 1), 1e-6f), shapes::translated(shapes::icosphere(2, 1), {300, 0, 0})}) {
        TriangleMesh same = mesh;
        EXPECT_EQ(remove_flat_faces(same), 0);
        EXPECT_EQ(same.faces, mesh.faces);
        EXPECT_TRUE(same.source_face.empty());
    }
}

TEST(RemoveFlatFaces, SplitsTheFaceAcrossTheLongestSide) {
    TriangleMesh mesh;
    mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0.3f, 0, 0}, {0, 1, 0}, {0.5f, -1, 0}};
    mesh.faces = {{1, 0, 4}, {0, 1, 2}, {0, 2, 3}, {2, 1, 3}};
    mesh.source_face_count = 4;
    EXPECT_EQ(remove_flat_faces(mesh), 1);
    EXPECT_EQ(mesh.faces, (std::vector<Face>{{2, 0, 4}, {1, 2, 4}, {0, 2, 3}, {2, 1, 3}}));
    EXPECT_EQ(mesh.source_face, (std::vector<std::uint32_t>{0, 0, 2, 3}));
    EXPECT_EQ(mesh.source_face_count, 4);
}

TEST(RemoveFlatFaces, LeavesNoGapsInClosedSurfaces) {
    for (const TriangleMesh& right : {shapes::torus(2, 0.5f, 16, 8), shapes::icosphere(3, 1), shapes::box(1, 2, 3, 2)})
        for (const std::size_t count : {1, 20, 200}) {
            TriangleMesh mesh = with_flat_faces(right, count, count);
            EXPECT_GT(remove_flat_faces(mesh), 0);
            const MeshReport report = validate_mesh(mesh);
            EXPECT_TRUE(report.clean()) << (report.clean() ? "" : report.messages().front());
            EXPECT_EQ(report.boundary_edges, 0);
            EXPECT_EQ(mesh.face_count(), 2 * (mesh.vertex_count() - right.vertex_count()) + right.face_count());
            EXPECT_NEAR(volume_of(mesh), volume_of(right), 1e-5 * volume_of(right));
            EXPECT_EQ(mesh.source_face.size(), mesh.face_count());
            const TriangleMesh once = mesh;
            EXPECT_EQ(remove_flat_faces(mesh), 0);
            EXPECT_EQ(mesh.faces, once.faces);
        }
}

TEST(RemoveFlatFaces, SplitsAFaceAtEachOfARowOfVertices) {
    // A quad whose lower side has 63 more vertices, joined to a triangle below by a fan of flat faces.
    constexpr std::uint32_t k_row = 64;
    TriangleMesh mesh;
    for (std::uint32_t i = 0; i <= k_row; ++i) mesh.vertices.push_back({static_cast<float>(i) / k_row, 0.1f, 0});
    mesh.vertices.push_back({0.5f, 2, 0});
    mesh.vertices.push_back({0.5f, -2, 0});
    const std::uint32_t top = k_row + 1, bottom = k_row + 2;
    for (std::uint32_t i = 0; i < k_row; ++i) mesh.faces.push_back({i, i + 1, top});
    for (std::uint32_t i = 1; i < k_row; ++i) mesh.faces.push_back({0, i + 1, i});
    mesh.faces.push_back({k_row, 0, bottom});
    std::vector<Face> right(mesh.faces.begin(), mesh.faces.begin() + k_row);
    for (std::uint32_t i = 0; i < k_row; ++i) right.push_back({i + 1, i, bottom});
    EXPECT_EQ(remove_flat_faces(mesh), k_row - 1);
    EXPECT_EQ(in_order(mesh.faces), in_order(right));
}

TEST(RemoveFlatFaces, LeavesOutFacesWithNothingAcross) {
    TriangleMesh mesh;
    mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0.5f, 0, 0}, {0.5f, 1, 0}};
    mesh.faces = {{1, 0, 2}, {0, 2, 3}, {2, 1, 3}};
    const std::vector<Face> right{{0, 2, 3}, {2, 1, 3}};
    EXPECT_EQ(remove_flat_faces(mesh), 1);
    EXPECT_EQ(mesh.faces, right);
}

TEST(RemoveFlatFaces, EndsOnHeapsOfFlatFaces) {
    // All triangles of the points of one line: no surface at all.
    TriangleMesh mesh;
    constexpr std::uint32_t k_points = 12;
    for (std::uint32_t i = 0; i < k_points; ++i) mesh.vertices.push_back({static_cast<float>(i * i), 1, 2});
    for (std::uint32_t i = 0; i < k_points; ++i)
        for (std::uint32_t j = 0; j < i; ++j)
            for (std::uint32_t k = 0; k < j; ++k) mesh.faces.push_back({i, j, k});
    TriangleMesh line = mesh;
    EXPECT_EQ(remove_flat_faces(line), 0);
    EXPECT_EQ(line.faces, mesh.faces);

    mesh = shapes::joined(mesh, shapes::grid(1, 1, 1));
    const std::vector<Face> sheet(mesh.faces.end() - 2, mesh.faces.end());
    EXPECT_EQ(remove_flat_faces(mesh), line.face_count());
    EXPECT_EQ(mesh.faces, sheet);
}

TEST(RemoveFlatFaces, DoesNotDependOnTheOrderOfFaces) {
    const TriangleMesh mesh = with_flat_faces(shapes::torus(2, 0.5f, 16, 8), 150, 4);
    TriangleMesh one = mesh, other = shapes::with_shuffled_faces(mesh, 9);
    remove_flat_faces(one);
    remove_flat_faces(other);
    EXPECT_EQ(in_order(one.faces), in_order(other.faces));
}

}  // namespace
}  // namespace exemplar
