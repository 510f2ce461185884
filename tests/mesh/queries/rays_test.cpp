#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include "host/core/parallel.h"
#include "host/mesh/queries/rays.h"
#include "host/mesh/queries/sliver_groups.h"
#include "tests/support/shapes.h"

namespace exemplar {
namespace {

Vec3 random_direction(Random& random) {
    return shapes::detail::vec3(random.normal(), random.normal(), random.normal()).normalized();
}

/// First hit by testing every face in double; the face `skipped` is left out.
std::optional<RayScene::Hit> naive_hit(const TriangleMesh& mesh, const Vec3& origin, const Vec3& direction,
                                       std::uint32_t skipped = ~0u) {
    std::optional<RayScene::Hit> best;
    for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
        if (f == skipped) continue;
        Eigen::Matrix3d system;  // origin + t direction = a + u (b - a) + v (c - a)
        const Vec3d a = mesh.vertices[mesh.faces[f][0]].cast<double>();
        system << -direction.cast<double>(), mesh.vertices[mesh.faces[f][1]].cast<double>() - a,
            mesh.vertices[mesh.faces[f][2]].cast<double>() - a;
        if (std::abs(system.determinant()) < 1e-30) continue;
        const Vec3d tuv = system.inverse() * (origin.cast<double>() - a);
        if (tuv[0] < 0 || tuv[1] < 0 || tuv[2] < 0 || tuv[1] + tuv[2] > 1) continue;
        if (!best || tuv[0] < static_cast<double>(best->distance)) best = {static_cast<float>(tuv[0]), f};
    }
    return best;
}

TEST(RayScene, AgreesWithTestingEveryFace) {
    Random random(1);
    TriangleMesh mesh = shapes::torus(3, 1, 24, 12);
    for (Vec3& p : mesh.vertices) p += 0.1f * random_direction(random);
    const RayScene scene(mesh);
    int hits = 0;
    for (int i = 0; i < 2000; ++i) {
        const Vec3 origin = 3 * random_direction(random), direction = random_direction(random);
        const auto expected = naive_hit(mesh, origin, direction), found = scene.first_hit(origin, direction, 0);
        ASSERT_EQ(expected.has_value(), found.has_value());
        if (!found) continue;
        ++hits;
        EXPECT_NEAR(found->distance, expected->distance, 1e-4);
        EXPECT_EQ(found->face, expected->face);
    }
    EXPECT_GT(hits, 500);
}

/// A cone closed by another below, with two vertices of n faces each, and a small ball in it.
TriangleMesh cone_around_a_ball(std::uint32_t n) {
    TriangleMesh cone;
    for (std::uint32_t i = 0; i < n; ++i) {
        const double turn = 2 * std::numbers::pi * i / n;
        cone.vertices.push_back(shapes::detail::vec3(std::cos(turn), std::sin(turn), 0));
    }
    cone.vertices.push_back({0, 0, 1.5f});
    cone.vertices.push_back({0, 0, -0.5f});
    for (std::uint32_t i = 0; i < n; ++i) {
        cone.faces.push_back({i, (i + 1) % n, n});
        cone.faces.push_back({(i + 1) % n, i, n + 1});
    }
    return shapes::joined(cone, shapes::icosphere(2, 0.2f));
}

TEST(RayScene, AgreesWithTestingEveryFaceOfAFan) {
    Random random(2);
    const TriangleMesh mesh = cone_around_a_ball(1500);
    ASSERT_FALSE(group_slivers(mesh).empty());
    const RayScene scene(mesh);
    const std::vector<Vec3> centers = face_centers(mesh);
    std::size_t other_face = 0;
    for (int i = 0; i < 400; ++i) {
        const auto from = static_cast<std::uint32_t>(random.index(mesh.face_count()));
        const Vec3 direction = random_direction(random);
        const auto expected = naive_hit(mesh, centers[from], direction, from),
                   found = scene.first_hit_from(from, centers[from], direction);
        if (expected && expected->distance < 1e-3f) continue;  // along the surface, to a neighbor
        ASSERT_EQ(expected.has_value(), found.has_value()) << i;
        if (!found) continue;
        EXPECT_NEAR(found->distance, expected->distance, 1e-4) << i;
        other_face += found->face != expected->face;  // on the edge between two
    }
    EXPECT_LE(other_face, 4u);
}

TEST(SliverGroups, HoldEachSliverOnceInNarrowFrames) {
    constexpr std::uint32_t k_around = 5000;
    const TriangleMesh mesh = cone_around_a_ball(k_around);
    const std::vector<SliverGroup> groups = group_slivers(mesh);
    std::vector<int> times(mesh.face_count(), 0);
    std::uint32_t wide = 0;
    for (const SliverGroup& group : groups) {
        EXPECT_LE(group.faces.size(), 100u);
        EXPECT_NEAR(group.rotation.determinant(), 1, 1e-5);
        for (const std::uint32_t f : group.faces) {
            ++times[f];
            Vec3 size = Vec3::Zero();
            for (int k = 0; k < 2; ++k) {
                const Vec3 edge =
                    mesh.vertices[mesh.faces[f][static_cast<std::size_t>(k) + 1]] - mesh.vertices[mesh.faces[f][0]];
                size = size.cwiseMax((group.rotation * edge).cwiseAbs());
            }
            wide += size.y() > 0.25f || size.z() > 0.1f;  // unrotated most are
        }
    }
    EXPECT_LT(wide, k_around / 5);  // few groups span two places
    EXPECT_EQ(std::ranges::count_if(times, [](int t) { return t > 1; }), 0);
    EXPECT_GT(std::ranges::count(times, 1), k_around);  // but for those along an axis
    EXPECT_LT(groups.size(), 400u);
    EXPECT_EQ(std::accumulate(times.begin() + 2 * k_around, times.end(), 0), 0);  // the ball has none
    EXPECT_TRUE(group_slivers(mesh, 2 * mesh.face_count()).empty());
    EXPECT_TRUE(group_slivers(shapes::icosphere(4, 1)).empty());
    EXPECT_TRUE(group_slivers({}).empty());
}

TEST(RayScene, NearIsTheLeastDistance) {
    const TriangleMesh mesh =
        shapes::joined(shapes::grid(1, 1, 1), shapes::translated(shapes::grid(1, 1, 1), {0, 0, 2}));
    const RayScene scene(mesh);
    const Vec3 origin(0.7f, 0.2f, -1), up(0, 0, 1);
    EXPECT_FLOAT_EQ(scene.first_hit(origin, up, 0)->distance, 1);
    EXPECT_FLOAT_EQ(scene.first_hit(origin, up, 1)->distance, 1);
    EXPECT_FLOAT_EQ(scene.first_hit(origin, up, 1.001f)->distance, 3);
    EXPECT_FALSE(scene.first_hit(origin, up, 3.001f));
    EXPECT_FALSE(scene.first_hit(origin, -up, 0));
}

TEST(RayScene, FromAFaceInsideASphereAlwaysLeavesThroughTheOtherSide) {
    const TriangleMesh mesh = shapes::icosphere(4, 1);
    const RayScene scene(mesh);
    const std::vector<Vec3> centers = face_centers(mesh), normals = face_normals(mesh);
    Random random(2);
    for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
        Vec3 direction = random_direction(random);
        if (direction.dot(normals[f]) > 0) direction = -direction;
        if (direction.dot(normals[f]) > -0.1f) continue;
        const auto hit = scene.first_hit_from(f, centers[f], direction);
        ASSERT_TRUE(hit) << f;
        EXPECT_NE(hit->face, f);
        EXPECT_NEAR(hit->distance, -2 * direction.dot(centers[f].normalized()), 0.03);
        EXPECT_FALSE(scene.first_hit_from(f, centers[f], -direction)) << f;
    }
}

TEST(RayScene, FromAFaceSeesAWallNearbyHoweverThin) {
    // Two sheets a tiny gap apart, far from the origin: a fixed epsilon would jump over the second one.
    for (const float gap : {1e-3f, 1e-5f}) {
        TriangleMesh mesh =
            shapes::joined(shapes::grid(3, 3, 1), shapes::translated(shapes::grid(2, 2, 1), {0, 0, -gap}));
        const RayScene scene(mesh);
        const std::vector<Vec3> centers = face_centers(mesh);
        for (std::uint32_t f = 0; f < 18; ++f) {
            const auto hit = scene.first_hit_from(f, centers[f], {0, 0, -1});
            ASSERT_TRUE(hit);
            EXPECT_GE(hit->face, 18u);
            EXPECT_NEAR(hit->distance / gap, 1, 1e-2);
        }
    }
}

TEST(RayScene, FromAnyPointOfAThinFaceMissesThatFace) {
    // Slivers of a closed, long, thin cylinder, shifted so that coordinates have few spare bits.
    const TriangleMesh mesh = shapes::translated(shapes::cylinder(0.01f, 10, 64, 1, true), {8, -7, 3});
    const RayScene scene(mesh);
    const std::vector<Vec3> centers = face_centers(mesh), normals = face_normals(mesh);
    for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
        const auto hit = scene.first_hit_from(f, centers[f], -normals[f]);
        ASSERT_TRUE(hit) << f;
        EXPECT_GT(hit->distance, 0.01f) << f;
    }
}

TEST(RayScene, GrazingRaysMissTheFaceTheyStartOn) {
    // A start that rounding puts below its own face comes up through it only after the error over the slope, which
    // no fixed offset covers.
    const TriangleMesh mesh = shapes::translated(shapes::icosphere(2, 1), {10, 20, -30});
    const RayScene scene(mesh);
    const std::vector<Vec3> centers = face_centers(mesh), normals = face_normals(mesh);
    for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
        const Vec3 along = (mesh.vertices[mesh.faces[f][0]] - centers[f]).normalized();
        for (const float slope : {1e-2f, 3e-3f})
            EXPECT_FALSE(scene.first_hit_from(f, centers[f], (along + slope * normals[f]).normalized())) << f;
    }
}

TEST(RayScene, FromAFaceIgnoresItsExactCopies) {
    TriangleMesh mesh = shapes::translated(shapes::box(1, 1, 1, 2), {5, 5, 5});
    const std::vector<Face> faces = mesh.faces;
    mesh.faces.insert(mesh.faces.end(), faces.begin(), faces.end());
    const RayScene scene(mesh);
    const std::vector<Vec3> centers = face_centers(mesh), normals = face_normals(mesh);
    for (std::uint32_t f = 0; f < mesh.face_count(); ++f)
        EXPECT_NEAR(scene.first_hit_from(f, centers[f], -normals[f])->distance, 1, 1e-5);
}

TEST(RayScene, DoesNotSlipThroughEdgesAndVertices) {
    const TriangleMesh mesh = shapes::icosphere(3, 1);
    const RayScene scene(mesh);
    for (const Face& face : mesh.faces)
        for (int i = 0; i < 3; ++i) {
            const Vec3 a = mesh.vertices[face[i]], b = mesh.vertices[face[(i + 1) % 3]];
            EXPECT_TRUE(scene.first_hit(Vec3::Zero(), a.normalized(), 0));
            EXPECT_TRUE(scene.first_hit(Vec3::Zero(), (a + b).normalized(), 0));
        }
}

TEST(RayScene, HandlesEmptyAndDegenerateMeshes) {
    EXPECT_FALSE(RayScene(TriangleMesh{}).first_hit({0, 0, 0}, {0, 0, 1}, 0));
    TriangleMesh mesh;
    mesh.vertices = {{0, 0, 1}, {1, 0, 1}, {2, 0, 1}};
    mesh.faces = {{0, 1, 2}, {0, 0, 0}};
    const RayScene scene(mesh);
    EXPECT_FALSE(scene.first_hit_from(0, {1, 0, 1}, {0, 0, 1}));
}

TEST(RayScene, MayBeMovedAndAskedFromManyThreads) {
    const TriangleMesh mesh = shapes::icosphere(3, 1);
    RayScene first(mesh);
    RayScene scene(shapes::grid(1, 1, 1));
    scene = std::move(first);
    const std::vector<Vec3> centers = face_centers(mesh);
    std::vector<std::uint32_t> hit(mesh.face_count());
    parallel_for(mesh.face_count(),
                 [&](std::size_t f) { hit[f] = scene.first_hit(Vec3::Zero(), centers[f].normalized(), 0)->face; });
    for (std::uint32_t f = 0; f < hit.size(); ++f) EXPECT_EQ(hit[f], f);
}

}  // namespace
}  // namespace exemplar
