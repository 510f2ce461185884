#include "host/mesh/editing/simplify.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numeric>

#include "host/core/errors.h"
#include "host/core/random.h"
#include "host/mesh/editing/validate.h"
#include "host/mesh/topology.h"
#include "tests/support/shapes.h"

namespace exemplar {
namespace {

double simplified_area(const TriangleMesh& mesh) {
    const std::vector<float> areas = face_areas(mesh);
    return std::accumulate(areas.begin(), areas.end(), 0.0);
}

/// Longest distance between the center of a face and that of the face which stands for it.
float farthest_shift(const TriangleMesh& mesh, const SimplifiedMesh& simple) {
    const std::vector<Vec3> from = face_centers(mesh), to = face_centers(simple.mesh);
    float farthest = 0;
    for (std::size_t f = 0; f < from.size(); ++f)
        farthest = std::max(farthest, (from[f] - to[simple.face_of[f]]).norm());
    return farthest;
}

TEST(Simplify, SmallMeshesStayAsTheyAre) {
    const TriangleMesh mesh = shapes::icosphere(2, 1.0F);
    const SimplifiedMesh simple = simplify_mesh(mesh, mesh.face_count());
    EXPECT_EQ(simple.mesh.faces, mesh.faces);
    for (std::uint32_t f = 0; f < mesh.face_count(); ++f) EXPECT_EQ(simple.face_of[f], f);
}

TEST(Simplify, ASphereStaysAClosedEvenSphere) {
    const TriangleMesh mesh = shapes::icosphere(5, 1.0F);  // 20,480 faces
    const SimplifiedMesh simple = simplify_mesh(mesh, 1000);
    EXPECT_NEAR(static_cast<double>(simple.mesh.face_count()), 1000, 50);
    const MeshReport report = validate_mesh(simple.mesh);
    EXPECT_TRUE(report.clean()) << report.messages().front();
    EXPECT_EQ(report.boundary_edges, 0U);
    EXPECT_FALSE(report.inside_out);
    EXPECT_NEAR(simplified_area(simple.mesh), simplified_area(mesh), 0.02 * simplified_area(mesh));
    for (const Vec3& v : simple.mesh.vertices) EXPECT_NEAR(v.norm(), 1, 0.01);
    std::vector<float> areas = face_areas(simple.mesh);
    std::ranges::sort(areas);
    EXPECT_GT(areas[areas.size() / 20], 0.4F * areas[areas.size() / 2]) << "hardly any slivers";
    const float largest = 3 * areas[areas.size() / 2];
    EXPECT_LT(areas.back(), largest);
    const float corner = std::sqrt(4 * largest / (3 * std::sqrt(3.0F)));  // from the center, with equal edges
    EXPECT_LT(farthest_shift(mesh, simple), corner) << "a face stands for those that lie on it";
}

TEST(Simplify, EdgesOfABoxStaySharp) {
    const TriangleMesh mesh = shapes::box(1.0F, 1.0F, 1.0F, 40);
    const SimplifiedMesh simple = simplify_mesh(mesh, 1200);
    EXPECT_NEAR(simplified_area(simple.mesh), 6, 0.06);
    for (const Vec3& v : simple.mesh.vertices) EXPECT_NEAR(v.cwiseAbs().maxCoeff(), 0.5F, 0.01F);
}

TEST(Simplify, DoesNotDependOnScaleOrPlace) {
    const TriangleMesh mesh = shapes::icosphere(4, 1.0F);
    const SimplifiedMesh expected = simplify_mesh(mesh, 500);
    for (const float scale : {1e-6F, 1e6F}) {
        TriangleMesh scaled = mesh;
        for (Vec3& v : scaled.vertices) v *= scale;
        const SimplifiedMesh simple = simplify_mesh(scaled, 500);
        EXPECT_NEAR(static_cast<double>(simple.mesh.face_count()), static_cast<double>(expected.mesh.face_count()), 25);
        EXPECT_NEAR(simplified_area(simple.mesh) / (double{scale} * scale), simplified_area(expected.mesh), 0.05);
        EXPECT_LT(farthest_shift(scaled, simple), 0.25F * scale);
    }
}

TEST(Simplify, SheetsThatLieCloseTogetherStayApart) {
    // Two parallel sheets whose gap is far below the size of the new faces.
    constexpr float k_gap = 1e-3F;
    TriangleMesh mesh = shapes::grid(60, 60, 1.0F);
    const auto vertices = static_cast<std::uint32_t>(mesh.vertex_count());
    const TriangleMesh sheet = mesh;
    for (const Vec3& v : sheet.vertices) mesh.vertices.emplace_back(v + Vec3(0, 0, k_gap));
    for (const Face& face : sheet.faces)
        mesh.faces.push_back({face[0] + vertices, face[2] + vertices, face[1] + vertices});
    const SimplifiedMesh simple = simplify_mesh(mesh, 800);
    EXPECT_EQ(validate_mesh(simple.mesh).components, 2U);
    const std::vector<Vec3> center = face_centers(simple.mesh);
    for (std::size_t f = 0; f < mesh.face_count(); ++f)
        EXPECT_NEAR(center[simple.face_of[f]].z(), f < sheet.face_count() ? 0 : k_gap, k_gap / 4) << f;
}

TEST(Simplify, DefectsAreNoObstacle) {
    TriangleMesh mesh = shapes::icosphere(4, 1.0F);
    Random random(7);
    for (std::size_t i = 0; i < 300; ++i) {
        const Face face = mesh.faces[random.index(mesh.face_count())];
        switch (i % 4) {
            case 0:
                mesh.faces.push_back(face);
                break;  // doubled
            case 1:
                mesh.faces.push_back({face[0], face[2], face[1]});
                break;  // turned around
            case 2:
                mesh.faces.push_back({face[0], face[0], face[1]});
                break;  // without area
            default:
                mesh.faces.push_back({face[0], face[1], static_cast<std::uint32_t>(random.index(1000))});
        }
    }
    mesh.vertices.emplace_back(1e6F, 0.0F, 0.0F);  // of no face
    const SimplifiedMesh simple = simplify_mesh(mesh, 600);
    EXPECT_GT(simple.mesh.face_count(), 400U);
    ASSERT_EQ(simple.face_of.size(), mesh.face_count());
    for (const std::uint32_t face : simple.face_of) EXPECT_LT(face, simple.mesh.face_count());
    for (const Vec3& v : simple.mesh.vertices) EXPECT_TRUE(v.allFinite());
}

TEST(Simplify, TinyPiecesVanishIntoWhatIsNear) {
    TriangleMesh mesh = shapes::icosphere(4, 1.0F);
    const auto first = static_cast<std::uint32_t>(mesh.vertex_count());
    mesh.vertices.emplace_back(0.0F, 0.0F, 1.1F);
    mesh.vertices.emplace_back(0.001F, 0.0F, 1.1F);
    mesh.vertices.emplace_back(0.0F, 0.001F, 1.1F);
    mesh.faces.push_back({first, first + 1, first + 2});
    const SimplifiedMesh simple = simplify_mesh(mesh, 500);
    EXPECT_EQ(validate_mesh(simple.mesh).components, 1U);
    EXPECT_LT((face_centers(simple.mesh)[simple.face_of.back()] - Vec3(0, 0, 1)).norm(), 0.15F);
}

TEST(Simplify, ASoupOfLooseTrianglesIsRefused) {
    const TriangleMesh sphere = shapes::icosphere(3, 1.0F);
    TriangleMesh soup;
    for (const Face& face : sphere.faces) {
        const auto first = static_cast<std::uint32_t>(soup.vertex_count());
        for (const std::uint32_t v : face) soup.vertices.push_back(sphere.vertices[v]);
        soup.faces.push_back({first, first + 1, first + 2});
    }
    EXPECT_THROW(simplify_mesh(soup, 100), MeshError);
}

TEST(Simplify, FacesBetweenVerticesAtRandomAreRefused) {
    TriangleMesh mesh = shapes::icosphere(4, 1.0F);
    Random random(7);
    for (Face& face : mesh.faces)
        for (std::uint32_t& v : face) v = static_cast<std::uint32_t>(random.index(mesh.vertex_count()));
    EXPECT_THROW(simplify_mesh(mesh, 500), MeshError);
}

}  // namespace
}  // namespace exemplar
