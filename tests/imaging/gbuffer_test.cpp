#include "host/imaging/gbuffer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <utility>

#include "host/core/errors.h"
#include "host/core/parallel.h"
#include "host/core/random.h"
#include "tests/support/shapes.h"

namespace exemplar {
namespace {

constexpr float k_infinite = std::numeric_limits<float>::infinity();

Camera parallel_camera() {
    return {.view = look_at(Vec3(0, 0, 10), Vec3::Zero()), .projection = orthographic(1, 1, 1, 20)};
}

Camera wide_camera(float aspect) {
    return {.view = look_at(Vec3::Zero(), Vec3(0, 0, -1)), .projection = perspective(1.5f, aspect, 0.1f, 200)};
}

Vec3 seen_point(const TriangleMesh& mesh, const GBuffer& gbuffer, std::size_t pixel) {
    const auto [a, b, c] = mesh.faces.at(gbuffer.face[pixel]);
    const auto [b1, b2] = gbuffer.barycentric[pixel];
    return (1 - b1 - b2) * mesh.vertices[a] + b1 * mesh.vertices[b] + b2 * mesh.vertices[c];
}

/// Every seen point lies in its face, on the ray through its pixel's center, at its depth. Next to edges coverage is
/// rounded to 1/256 of a pixel, which is more along a face that is seen obliquely.
void expect_consistent(const TriangleMesh& mesh, const Camera& camera, const GBuffer& gbuffer) {
    std::size_t seen = 0, moved = 0;
    for (std::size_t p = 0; p < gbuffer.size(); ++p) {
        const auto [b1, b2] = gbuffer.barycentric[p];
        ASSERT_GE(std::min(b1, b2), 0);
        ASSERT_LE(b1 + b2, 1.000001f);
        if (gbuffer.face[p] == k_no_face) {
            EXPECT_EQ(gbuffer.depth[p], k_infinite);
            EXPECT_EQ(b1 + b2, 0);
            continue;
        }
        ++seen;
        const Vec3 point = seen_point(mesh, gbuffer, p);
        const Vec3 place = camera.project(point, gbuffer.width, gbuffer.height);
        const std::size_t x = p % static_cast<std::size_t>(gbuffer.width);
        const std::size_t y = p / static_cast<std::size_t>(gbuffer.width);
        const float off = (place.head<2>() - Vec2(x, y) - Vec2::Constant(0.5f)).norm();
        EXPECT_LT(off, 4.0f / 256) << p;
        moved += off > 1e-3f;
        const float depth = -(camera.view * point.homogeneous()).z();
        EXPECT_NEAR(gbuffer.depth[p], depth, 1e-5f * depth) << p;
    }
    EXPECT_GT(seen, 0u);
    EXPECT_LT(moved, 1 + seen / 50);
}

TEST(GBuffer, KnowsFacePlaceAndDepthOfEveryPixelOfARectangle) {
    TriangleMesh mesh;  // covers pixels 4..11 x 2..7 of 16 x 16, at depth 8
    mesh.vertices = {Vec3(-0.5f, 0, 2), Vec3(0.5f, 0, 2), Vec3(0.5f, 0.75f, 2), Vec3(-0.5f, 0.75f, 2)};
    mesh.faces = {{0, 1, 2}, {0, 2, 3}};
    const GBuffer gbuffer = render_gbuffer(mesh, parallel_camera(), 16, 16);
    ASSERT_EQ(gbuffer.size(), 256u);
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 16; ++x) {
            const std::size_t p = gbuffer.index(x, y);
            const bool inside = x >= 4 && x < 12 && y >= 2 && y < 8;
            ASSERT_EQ(gbuffer.face[p] != k_no_face, inside) << x << ' ' << y;
            if (!inside) continue;
            const float u = (static_cast<float>(x) - 3.5f) / 8, v = (7.5f - static_cast<float>(y)) / 6;
            EXPECT_EQ(gbuffer.face[p], u > v ? 0u : 1u);
            EXPECT_NEAR(gbuffer.depth[p], 8, 1e-5f);
            EXPECT_TRUE(seen_point(mesh, gbuffer, p).isApprox(Vec3(u - 0.5f, 0.75f * v, 2), 1e-5f));
        }
}

TEST(GBuffer, BarycentricsAndDepthAreOfThePointOnTheRay) {
    const TriangleMesh mesh = shapes::torus(2.0f, 0.7f, 24, 12);
    for (const float fov : {0.0f, 0.4f, 1.4f})
        for (const auto& [width, height] : {std::pair(65, 63), std::pair(200, 40), std::pair(31, 80)}) {
            const float aspect = static_cast<float>(width) / static_cast<float>(height);
            const Camera camera = fit_camera(mesh, Vec3(0.4f, 0.8f, 1), aspect, {.vertical_fov = fov});
            expect_consistent(mesh, camera, render_gbuffer(mesh, camera, width, height));
        }
}

TEST(GBuffer, FacesThatCrossTheNearPlaneOrGoBehindTheEyeAreCut) {
    TriangleMesh floor;  // runs from far in front of the eye to far behind it, half a unit below
    floor.vertices = {Vec3(-50, -0.5f, -50), Vec3(-50, -0.5f, 50), Vec3(50, -0.5f, 50), Vec3(50, -0.5f, -50)};
    floor.faces = {{0, 1, 2}, {0, 2, 3}};
    const GBuffer gbuffer = render_gbuffer(floor, wide_camera(1), 41, 41);
    for (int y = 0; y < 41; ++y) {
        const float slope = std::tan(0.75f) * (static_cast<float>(2 * y + 1) / 41 - 1);
        const float depth = slope > 0.011f ? 0.5f / slope : k_infinite;
        for (int x = 0; x < 41; ++x) {
            const float seen = gbuffer.depth[gbuffer.index(x, y)];
            if (depth == k_infinite)
                EXPECT_EQ(seen, depth);
            else
                EXPECT_NEAR(seen, depth, 1e-4f * depth) << x << ' ' << y;
        }
    }
    expect_consistent(floor, wide_camera(1), gbuffer);

    // Nearer than the near plane, nothing is seen.
    for (Vec3& vertex : floor.vertices) vertex.y() = -0.09f;
    const GBuffer close = render_gbuffer(floor, wide_camera(1), 41, 41);
    for (const float depth : close.depth) EXPECT_GE(depth, 0.0999f);
    EXPECT_EQ(close.face[std::size_t{41} * 40 + 20], k_no_face);
    EXPECT_NE(close.face[std::size_t{41} * 30 + 20], k_no_face);
}

TEST(GBuffer, NothingIsSeenOfWhatIsBehindOrOutsideTheView) {
    const TriangleMesh ball = shapes::icosphere(2, 1);
    for (const Vec3& place : {Vec3(0, 0, 5), Vec3(500, 0, -5), Vec3(0, 0, -500)}) {
        TriangleMesh moved = ball;
        for (Vec3& vertex : moved.vertices) vertex += place;
        const GBuffer gbuffer = render_gbuffer(moved, wide_camera(1), 20, 20);
        EXPECT_EQ(gbuffer.face, std::vector<std::uint32_t>(400, k_no_face));
        EXPECT_EQ(gbuffer.depth, std::vector<float>(400, k_infinite));
    }
    EXPECT_EQ(render_gbuffer({}, wide_camera(1), 1, 1).face, std::vector<std::uint32_t>(1, k_no_face));
}

TEST(GBuffer, BothSidesAreTheSame) {
    const TriangleMesh mesh = shapes::icosphere(2, 1);
    TriangleMesh inside_out = mesh;
    for (Face& face : inside_out.faces) std::swap(face[1], face[2]);
    const Camera camera = fit_camera(mesh, Vec3(1, 2, 3), 1);
    const GBuffer one = render_gbuffer(mesh, camera, 50, 50), other = render_gbuffer(inside_out, camera, 50, 50);
    EXPECT_EQ(one.face, other.face);
    for (std::size_t p = 0; p < one.size(); ++p) {
        if (one.face[p] == k_no_face) continue;
        EXPECT_NEAR(one.depth[p], other.depth[p], 1e-6f * one.depth[p]);
        EXPECT_NEAR(one.barycentric[p][0], other.barycentric[p][1], 1e-6f);
    }
}

TEST(GBuffer, OfEquallyNearFacesTheFirstIsSeen) {
    TriangleMesh mesh = shapes::icosphere(1, 1);
    const auto faces = static_cast<std::uint32_t>(mesh.faces.size());
    for (std::uint32_t f = 0; f < faces; ++f) mesh.faces.push_back(mesh.faces[f]);
    const GBuffer gbuffer = render_gbuffer(mesh, fit_camera(mesh, Vec3(1, 2, 3), 1), 30, 30);
    for (const std::uint32_t face : gbuffer.face) EXPECT_TRUE(face == k_no_face || face < faces) << face;
}

TEST(GBuffer, IsTheSameOnAnyNumberOfThreads) {
    Random random(4);
    TriangleMesh mesh;
    for (std::uint32_t i = 0; i < 100; ++i) {
        for (int k = 0; k < 3; ++k) mesh.vertices.emplace_back(random.normal(), random.normal(), random.normal());
        mesh.faces.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    const Camera camera = fit_camera(mesh, Vec3::Ones(), 1.3f);
    const GBuffer many = render_gbuffer(mesh, camera, 130, 100);
    const ThreadLimit one(1);
    const GBuffer single = render_gbuffer(mesh, camera, 130, 100);
    EXPECT_EQ(single.face, many.face);
    EXPECT_EQ(single.barycentric, many.barycentric);
    EXPECT_EQ(single.depth, many.depth);
}

TEST(GBuffer, RefusesEmptyImages) {
    EXPECT_THROW(render_gbuffer({}, Camera{}, 0, 5), UsageError);
    EXPECT_THROW(CpuGBufferRenderer().render({}, Camera{}, 5, -1), UsageError);
}

}  // namespace
}  // namespace exemplar
