#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "gpu/imaging/gbuffer_renderer.h"
#include "gpu/runtime/vulkan/errors.h"
#include "gpu/runtime/vulkan/functions.h"
#include "host/core/random.h"
#include "host/imaging/gbuffer.h"
#include "tests/gpu/support/environment.h"
#include "tests/support/shapes.h"

// Faces differ only where an edge passes a pixel's center: devices round vertex positions to between 1/16 and 1/256 of
// a pixel, the reference to 1/256. Points are found from unrounded positions on both sides. The device's floats know
// where a face lies to better than 1e-3 pixels; seen at an angle, that is a larger share of the face the lower it is.
namespace exemplar {
namespace {

using test_support::shared_device;

constexpr float k_infinite = std::numeric_limits<float>::infinity();
constexpr double k_place_error = 1e-3;  // pixels
constexpr double k_rounding = 1e-5;     // of barycentrics, and of depths relative to the largest of the face

/// By how much vertices may be off when they are drawn, in pixels.
double pixel_rounding() {
    VkPhysicalDeviceProperties properties{};
    vkGetPhysicalDeviceProperties(shared_device().physical(), &properties);
    return 1.0 / (1u << properties.limits.subPixelPrecisionBits);
}

/// The share of pixels that may show another face, of faces no smaller than 50 pixels.
double differing_share() {
    return 0.002 + 0.6 * pixel_rounding();
}

/// The share that may show a face which the reference does not show within a pixel: smaller ones, where they turn away.
double strange_share() {
    return std::max(0.001, 0.05 * pixel_rounding());
}

/// What the rounding of a pixel's place does to barycentrics: over the least height of the face in the picture.
double barycentric_error(const TriangleMesh& mesh, const Camera& camera, const GBuffer& gbuffer, std::uint32_t face) {
    std::array<Vec2, 3> p;
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3& corner = mesh.vertices[mesh.faces[face][i]];
        const float w = (camera.view_projection() * corner.homogeneous()).w();
        const float distance = (camera.view * corner.homogeneous()).head<3>().norm();
        if (w < 0.01f * std::min(distance, 1.0f)) return 1e-3;  // no place behind the eye
        p[i] = camera.project(corner, gbuffer.width, gbuffer.height).head<2>();
    }
    const auto twice_area =
        static_cast<double>(std::abs((p[1] - p[0]).x() * (p[2] - p[0]).y() - (p[1] - p[0]).y() * (p[2] - p[0]).x()));
    const auto longest =
        static_cast<double>(std::max({(p[1] - p[0]).norm(), (p[2] - p[1]).norm(), (p[0] - p[2]).norm()}));
    return k_rounding + k_place_error * longest / std::max(twice_area, 1e-12);
}

void expect_same_point(const TriangleMesh& mesh, const Camera& camera, const GBuffer& expected, const GBuffer& actual,
                       std::size_t pixel) {
    const std::uint32_t face = expected.face[pixel];
    if (face == k_no_face) {
        ASSERT_EQ(actual.depth[pixel], k_infinite);
        ASSERT_EQ(actual.barycentric[pixel], (std::array<float, 2>{}));
        return;
    }
    const double error = barycentric_error(mesh, camera, expected, face);
    for (std::size_t c = 0; c < 2; ++c)
        ASSERT_NEAR(actual.barycentric[pixel][c], expected.barycentric[pixel][c], error) << "pixel " << pixel;
    double low = 1e30, high = -1e30;
    for (const std::uint32_t v : mesh.faces[face]) {
        const auto depth = static_cast<double>(-(camera.view * mesh.vertices[v].homogeneous()).z());
        low = std::min(low, depth);
        high = std::max(high, depth);
    }
    ASSERT_NEAR(actual.depth[pixel], expected.depth[pixel],
                2 * error * (high - low) + k_rounding * std::max(std::abs(low), std::abs(high)))
        << "pixel " << pixel;
}

/// Whether the reference shows a face within a pixel of this one.
bool shown_nearby(const GBuffer& gbuffer, int x, int y, std::uint32_t face) {
    for (int v = std::max(0, y - 1); v <= std::min(gbuffer.height - 1, y + 1); ++v)
        for (int u = std::max(0, x - 1); u <= std::min(gbuffer.width - 1, x + 1); ++u)
            if (gbuffer.face[gbuffer.index(u, v)] == face) return true;
    return false;
}

void expect_gbuffer_parity(GBufferRenderer& device, const TriangleMesh& mesh, const Camera& camera, int width,
                           int height) {
    const GBuffer expected = render_gbuffer(mesh, camera, width, height);
    const GBuffer actual = device.render(mesh, camera, width, height);
    ASSERT_EQ(actual.width, width);
    ASSERT_EQ(actual.height, height);
    ASSERT_EQ(actual.face.size(), expected.face.size());
    std::size_t differing = 0, strange = 0;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const std::size_t p = expected.index(x, y);
            ASSERT_TRUE(actual.face[p] == k_no_face || actual.face[p] < mesh.face_count());
            if (actual.face[p] != expected.face[p]) {
                ++differing;
                strange += !shown_nearby(expected, x, y, actual.face[p]);
            } else {
                ASSERT_NO_FATAL_FAILURE(expect_same_point(mesh, camera, expected, actual, p));
            }
        }
    EXPECT_LE(static_cast<double>(differing), 1 + differing_share() * static_cast<double>(expected.size()));
    EXPECT_LE(static_cast<double>(strange), strange_share() * static_cast<double>(expected.size()));
}

float aspect_of(int width, int height) {
    return static_cast<float>(width) / static_cast<float>(height);
}

Camera eye_at_origin() {
    return {.view = look_at(Vec3::Zero(), Vec3(0, 0, -1)), .projection = perspective(1.5f, 1, 0.1f, 200)};
}

TEST(GBufferParity, SurfacesAtOddSizes) {
    GpuGBufferRenderer renderer(shared_device());
    const TriangleMesh mesh = shapes::torus(2.0f, 0.7f, 48, 24);
    for (const auto& [width, height] : {std::pair(1, 1), std::pair(65, 63), std::pair(1, 100), std::pair(257, 129)})
        for (const float fov : {0.0f, 0.4f, 1.4f}) {
            SCOPED_TRACE(::testing::Message() << width << " x " << height << ", " << fov);
            const Camera camera =
                fit_camera(mesh, Vec3(0.4f, 0.8f, 1), aspect_of(width, height), {.vertical_fov = fov});
            expect_gbuffer_parity(renderer, mesh, camera, width, height);
        }
}

TEST(GBufferParity, FacesOfAPixelAndTinyUnits) {
    GpuGBufferRenderer renderer(shared_device());
    for (const float unit : {1e-8f, 1.0f, 1e7f}) {
        SCOPED_TRACE(unit);
        TriangleMesh mesh = shapes::icosphere(4, unit);
        for (Vec3& v : mesh.vertices) v += unit * Vec3(3, -2, 1);
        // Faces are so small that edges pass many pixels.
        const Camera camera = fit_camera(mesh, Vec3(1, 2, 3), 1);
        expect_gbuffer_parity(renderer, mesh, camera, 400, 400);
    }
}

TEST(GBufferParity, TrianglesThatPierceEachOther) {
    GpuGBufferRenderer renderer(shared_device());
    Random random(4);
    TriangleMesh mesh;
    for (std::uint32_t i = 0; i < 60; ++i) {
        for (int k = 0; k < 3; ++k) mesh.vertices.emplace_back(random.normal(), random.normal(), random.normal());
        mesh.faces.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    expect_gbuffer_parity(renderer, mesh, fit_camera(mesh, Vec3(1, 1, 1), 1.3f), 131, 101);
}

TEST(GBufferParity, NothingInView) {
    GpuGBufferRenderer renderer(shared_device());
    const TriangleMesh ball = shapes::icosphere(2, 1);
    for (const Vec3& place : {Vec3(0, 0, 5), Vec3(500, 0, -5), Vec3(0, 0, -500)}) {
        TriangleMesh moved = ball;
        for (Vec3& vertex : moved.vertices) vertex += place;
        const GBuffer gbuffer = renderer.render(moved, eye_at_origin(), 65, 63);
        EXPECT_EQ(gbuffer.face, std::vector<std::uint32_t>(gbuffer.size(), k_no_face));
        EXPECT_EQ(gbuffer.depth, std::vector<float>(gbuffer.size(), k_infinite));
    }
    expect_gbuffer_parity(renderer, {}, eye_at_origin(), 7, 5);
}

TEST(GBufferParity, AcrossTheNearPlaneAndBehindTheEye) {
    GpuGBufferRenderer renderer(shared_device());
    TriangleMesh floor;
    floor.vertices = {Vec3(-50, -0.5f, -50), Vec3(-50, -0.5f, 50), Vec3(50, -0.5f, 50), Vec3(50, -0.5f, -50)};
    floor.faces = {{0, 1, 2}, {0, 2, 3}};
    for (const float height : {-0.5f, -0.09f, 0.3f}) {
        for (Vec3& vertex : floor.vertices) vertex.y() = height;
        expect_gbuffer_parity(renderer, floor, eye_at_origin(), 65, 63);
    }
    // The eye is inside of the ball.
    expect_gbuffer_parity(renderer, shapes::icosphere(3, 0.3f), eye_at_origin(), 65, 63);
}

TEST(GBufferParity, OfEquallyNearFacesTheFirstIsSeen) {
    GpuGBufferRenderer renderer(shared_device());
    TriangleMesh mesh = shapes::icosphere(1, 1);
    const auto faces = static_cast<std::uint32_t>(mesh.faces.size());
    for (std::uint32_t f = 0; f < faces; ++f) mesh.faces.push_back(mesh.faces[f]);
    const GBuffer gbuffer = renderer.render(mesh, fit_camera(mesh, Vec3(1, 2, 3), 1), 60, 60);
    for (const std::uint32_t face : gbuffer.face) EXPECT_TRUE(face == k_no_face || face < faces) << face;
}

TEST(GBufferParity, TilesAndPartsChangeNothingButEdges) {
    const TriangleMesh mesh = shapes::torus(2.0f, 0.7f, 30, 20);
    const Camera camera = fit_camera(mesh, Vec3(0.6f, 0.5f, 1.0f), aspect_of(150, 101));
    GpuGBufferRenderer tiled(shared_device(), 32), in_parts(shared_device(), 2048, 7 * 48 + 5), whole(shared_device());
    expect_gbuffer_parity(tiled, mesh, camera, 150, 101);
    const GBuffer expected = whole.render(mesh, camera, 150, 101), actual = in_parts.render(mesh, camera, 150, 101);
    EXPECT_EQ(actual.face, expected.face);
    EXPECT_EQ(actual.depth, expected.depth);
    EXPECT_EQ(actual.barycentric, expected.barycentric);
}

TEST(GBufferParity, RerunsAndOtherSizesBetweenThemChangeNothing) {
    GpuGBufferRenderer renderer(shared_device());
    const TriangleMesh mesh = shapes::icosphere(3, 1.0f), other = shapes::box(1, 1, 1, 3);
    const Camera camera = fit_camera(mesh, {1, 2, 3}, 1.0f);
    const GBuffer first = renderer.render(mesh, camera, 75, 75);
    for (const auto& [width, height] : {std::pair(1, 1), std::pair(300, 2), std::pair(7, 200)})
        renderer.render(other, fit_camera(other, {1, 1, 2}, aspect_of(width, height)), width, height);
    const GBuffer again = renderer.render(mesh, camera, 75, 75);
    EXPECT_EQ(again.face, first.face);
    EXPECT_EQ(again.depth, first.depth);
    EXPECT_EQ(again.barycentric, first.barycentric);
}

TEST(GBufferParity, RefusesWhatCannotBeRendered) {
    EXPECT_THROW(GpuGBufferRenderer(shared_device(), 0), UsageError);
    GpuGBufferRenderer renderer(shared_device());
    EXPECT_THROW(renderer.render({}, Camera{}, 0, 8), UsageError);
    EXPECT_THROW(renderer.render({}, Camera{}, 8, -1), UsageError);
    EXPECT_THROW(renderer.render({}, Camera{}, 1 << 24, 1 << 24), DeviceLimitError);
    // The renderer is of use after the error.
    EXPECT_EQ(renderer.render({}, Camera{}, 1, 1).face, std::vector<std::uint32_t>(1, k_no_face));
}

}  // namespace
}  // namespace exemplar
