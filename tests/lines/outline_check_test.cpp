#include "host/lines/outline_check.h"

#include <gtest/gtest.h>

#include <array>

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

TEST(OutlineChecks, OfDrawingsOfManyShapesAreComplete) {
    const std::array shapes = {shapes::box(1, 2, 3, 1),    shapes::cylinder(1, 2, 8, 1, true),
                               shapes::icosphere(0, 1),    shapes::cylinder(1, 1, 64, 4, true),
                               shapes::grid(3, 2, 1),      shapes::torus(3, 1, 12, 7),
                               shapes::torus(3, 1, 60, 30)};
    for (const TriangleMesh& mesh : shapes) {
        const OutlinedScene scene(mesh);
        DrawableSurface surface(mesh.faces, mesh.vertices, {.curvature = {.derivatives = false, .smoothing = 1}});
        surface.measure(mesh.vertices);
        const Drawing drawing =
            draw_lines(surface.surface(), std::array{LineType::contours}, load_style("ink"), scene.view);
        const InkMask ink = ink_of(drawing);
        const OutlineCheck check = check_outline(mesh, scene.view.camera, ink, ink);
        EXPECT_GT(check.outlined_share(), 0.99) << mesh.face_count();
        EXPECT_LT(check.stray_share(), 0.03) << mesh.face_count();
    }
}

}  // namespace
}  // namespace exemplar
