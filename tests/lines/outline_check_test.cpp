#include "host/lines/outline_check.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "host/core/errors.h"
#include "host/lines/extraction/drawable_surface.h"
#include "tests/lines/drawn_scene.h"

namespace exemplar {
namespace {

using OutlinedScene = test_support::Scene;

InkMask none(const OutlinedScene& scene) {
    return InkMask(scene.view.width, scene.view.height, 1);
}

TEST(OutlineChecks, FindALineForEveryPixelOfTheSilhouette) {
    const OutlinedScene ball(shapes::icosphere(4, 1));
    const Drawing drawing = test_support::draw(ball, load_style("ink"), std::array{LineType::contours});
    const InkMask ink = ink_of(drawing, LineType::contours);
    const OutlineCheck check = check_outline(ball.mesh, ball.view.camera, ink, ink);
    EXPECT_GT(check.silhouette, 1000);
    EXPECT_EQ(check.outlined_share(), 1);
    EXPECT_GT(check.contours, 1000);
    EXPECT_EQ(check.stray_share(), 0);
    EXPECT_EQ(check_outline(ball.mesh, ball.view.camera, none(ball), ink).outlined_share(), 0);
    EXPECT_THROW(check_outline(ball.mesh, ball.view.camera, ink, InkMask(3, 3, 1)), UsageError);
}

TEST(OutlineChecks, CountContoursWithoutAnEdge) {
    // The middle row of a ball's picture: ends at the outline, and nothing but ball between.
    const OutlinedScene ball(shapes::icosphere(4, 1));
    InkMask row = none(ball);
    for (int x = 0; x < row.width; ++x) row.pixel(x, row.height / 2)[0] = 1;
    const OutlineCheck check = check_outline(ball.mesh, ball.view.camera, none(ball), row);
    EXPECT_EQ(check.contours, static_cast<std::size_t>(row.width));
    EXPECT_GT(check.stray_share(), 0.9);
}

/// A ring whose cross section is this polygon of radii and heights.
TriangleMesh revolved(const std::vector<Vec2>& section, std::uint32_t steps) {
    TriangleMesh mesh;
    const auto sides = static_cast<std::uint32_t>(section.size());
    for (std::uint32_t i = 0; i < steps; ++i) {
        const float angle = 2 * std::numbers::pi_v<float> * static_cast<float>(i) / static_cast<float>(steps);
        for (const Vec2& at : section)
            mesh.vertices.emplace_back(at.x() * std::cos(angle), at.x() * std::sin(angle), at.y());
        for (std::uint32_t j = 0; j < sides; ++j) {
            const std::uint32_t a = i * sides + j, b = i * sides + (j + 1) % sides;
            const std::uint32_t c = (i + 1) % steps * sides + j, d = (i + 1) % steps * sides + (j + 1) % sides;
            mesh.faces.push_back({a, c, d});
            mesh.faces.push_back({a, d, b});
        }
    }
    return mesh;
}

OutlineCheck checked_drawing(const TriangleMesh& mesh, const Vec3& direction = {3, 2, 4}) {
    const OutlinedScene scene(mesh, direction);
    DrawableSurface surface(mesh.faces, mesh.vertices, {.curvature = {.derivatives = false, .smoothing = 1}});
    surface.measure(mesh.vertices);
    const Drawing drawing =
        draw_lines(surface.surface(), std::array{LineType::contours}, load_style("ink"), scene.view);
    const InkMask ink = ink_of(drawing);
    return check_outline(mesh, scene.view.camera, ink, ink);
}

TEST(OutlineChecks, OfDrawingsOfManyShapesAreComplete) {
    const std::array shapes = {shapes::box(1, 2, 3, 1),    shapes::cylinder(1, 2, 8, 1, true),
                               shapes::icosphere(0, 1),    shapes::cylinder(1, 1, 64, 4, true),
                               shapes::grid(3, 2, 1),      shapes::torus(3, 1, 12, 7),
                               shapes::torus(3, 1, 60, 30)};
    for (const TriangleMesh& mesh : shapes) {
        const OutlineCheck check = checked_drawing(mesh);
        EXPECT_GT(check.outlined_share(), 0.99) << mesh.face_count();
        EXPECT_LT(check.stray_share(), 0.03) << mesh.face_count();
    }
}

TEST(OutlineChecks, OfAChamferThatJustTurnsAwayAreComplete) {
    // Smooth normals of the chamfer face the eye on the outline where its polygons do not.
    const TriangleMesh flange =
        revolved({{0.5f, -0.175f}, {0.5f, 0.1494f}, {0.4925f, 0.157f}, {0.3f, 0.157f}, {0.3f, -0.175f}}, 56);
    EXPECT_GT(checked_drawing(flange, {0.6f, 0.35f, 1}).outlined_share(), 0.999);
}

}  // namespace
}  // namespace exemplar
