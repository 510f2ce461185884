#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <numeric>

#include "host/mesh/mesh.h"
#include "tests/support/shapes.h"

namespace exemplar {
namespace {

double summed_area(const TriangleMesh& mesh) {
    double sum = 0;
    for (float area : face_areas(mesh)) sum += area;
    return sum;
}

TEST(FaceAreas, SumToTheAreaOfTheShape) {
    EXPECT_NEAR(summed_area(shapes::box(1, 2, 3, 4)), 22, 1e-5);
    EXPECT_NEAR(summed_area(shapes::grid(7, 3, 2)), 4, 1e-6);
    EXPECT_NEAR(summed_area(shapes::icosphere(5, 2)), 16 * std::numbers::pi, 0.02);
    EXPECT_NEAR(summed_area(shapes::torus(3, 1, 200, 100)), 12 * std::numbers::pi * std::numbers::pi, 0.1);
}

TEST(FaceAreas, AreZeroOnlyWhereDegenerate) {
    TriangleMesh mesh;
    mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1e-12f, 0}};
    mesh.faces = {{0, 1, 2}, {0, 0, 1}, {0, 1, 3}};
    const std::vector<float> areas = face_areas(mesh);
    EXPECT_EQ(areas[0], 0);
    EXPECT_EQ(areas[1], 0);
    EXPECT_NEAR(areas[2] / 0.5e-12, 1, 1e-5);
}

TEST(FaceNormals, AreUnitAndPointOutward) {
    const TriangleMesh mesh = shapes::icosphere(3, 2);
    const std::vector<Vec3> normals = face_normals(mesh), centers = face_centers(mesh);
    for (std::size_t f = 0; f < mesh.face_count(); ++f) {
        EXPECT_NEAR(normals[f].norm(), 1, 1e-6);
        EXPECT_GT(normals[f].dot(centers[f].normalized()), 0.99f);
    }
}

TEST(FaceNormals, OfThinAndTinyFacesAreExact) {
    TriangleMesh mesh;
    mesh.vertices = {{0, 0, 0}, {1e-18f, 0, 0}, {0, 0, 1e-20f}, {1e5f, 0, 0}, {0, 0, 1e-3f}};
    mesh.faces = {{0, 1, 2}, {0, 3, 4}};
    for (const Vec3& n : face_normals(mesh)) EXPECT_LT((n + Vec3::UnitY()).norm(), 1e-6f);
}

TEST(FaceNormals, OfDegenerateFacesFollowTheNeighborsElsePointUp) {
    TriangleMesh mesh;
    mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, {5, 5, 5}, {6, 6, 6}, {7, 7, 7}};
    mesh.faces = {{0, 1, 2}, {0, 0, 1}, {3, 4, 5}};
    const std::vector<Vec3> normals = face_normals(mesh);
    EXPECT_LT((normals[1] - normals[0]).norm(), 1e-6f);
    EXPECT_EQ(normals[2], Vec3::UnitZ());
}

TEST(VertexNormals, AreExactOnAnySphericalMesh) {
    // Max's weights give the exact normal where all vertices around lie on a sphere, however uneven.
    TriangleMesh mesh = shapes::icosphere(3, 1);
    Random random(3);
    for (Vec3& p : mesh.vertices) {
        for (int i = 0; i < 3; ++i) p[i] += static_cast<float>(random.uniform(-0.03, 0.03));
        p = 1.7f * p.normalized();
    }
    const std::vector<Vec3> normals = vertex_normals(mesh);
    for (std::size_t v = 0; v < normals.size(); ++v)
        EXPECT_LT((normals[v] - mesh.vertices[v].normalized()).norm(), 2e-6f);
}

TEST(VertexNormals, IgnoreDegenerateFacesAndPointUpWhereUnreferenced) {
    TriangleMesh mesh;
    mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, {9, 9, 9}, {3, 0, 0}};
    mesh.faces = {{0, 1, 2}, {0, 1, 4}, {1, 1, 2}};
    const std::vector<Vec3> normals = vertex_normals(mesh);
    for (std::size_t v : {0, 1, 2}) EXPECT_LT((normals[v] + Vec3::UnitY()).norm(), 1e-6f);
    EXPECT_EQ(normals[3], Vec3::UnitZ());
    EXPECT_EQ(normals[4], Vec3::UnitZ());
}

TEST(VertexNormals, IgnoreFacesThatNameAVertexTwice) {
    const TriangleMesh mesh = shapes::rotated(shapes::icosphere(2, 1.7f), shapes::random_rotation(5));
    TriangleMesh with_junk = mesh;
    for (std::uint32_t v = 0; v < 100; ++v)
        for (const Face& twice : {Face{v, v, v + 1}, Face{v, v + 1, v}, Face{v + 1, v, v}})
            with_junk.faces.push_back(twice);
    EXPECT_EQ(vertex_normals(with_junk), vertex_normals(mesh));
}

TEST(AreaCentroid, DoesNotDependOnTessellation) {
    TriangleMesh coarse_and_fine = shapes::grid(1, 1, 2);
    coarse_and_fine = shapes::joined(coarse_and_fine, shapes::translated(shapes::grid(20, 20, 2), {4, 0, 0}));
    EXPECT_LT((area_centroid(coarse_and_fine) - Vec3(3, 1, 0)).norm(), 1e-5f);
}

TEST(AreaCentroid, OfDegenerateAndEmptyMeshesIsFinite) {
    TriangleMesh mesh;
    EXPECT_EQ(area_centroid(mesh), Vec3::Zero());
    mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
    mesh.faces = {{0, 1, 2}};
    EXPECT_LT((area_centroid(mesh) - Vec3(1, 0, 0)).norm(), 1e-6f);
}

}  // namespace
}  // namespace exemplar
