#include "host/lines/drawing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "host/core/errors.h"
#include "host/imaging/image.h"
#include "host/lines/extraction/drawable_surface.h"
#include "tests/lines/drawn_scene.h"

namespace exemplar {
namespace {

using namespace test_support;

/// Depths of the nearest surface at pixel centers, by the plainest of rasterizers.
FloatImage depth_picture(const Scene& scene) {
    FloatImage image(k_size, k_size, 1, 1.0f);
    for (const Face& face : scene.mesh.faces) {
        std::array<Vec3, 3> p;
        for (std::size_t i = 0; i < 3; ++i)
            p[i] = scene.view.camera.project(scene.mesh.vertices[face[i]], k_size, k_size);
        const auto cross = [](const Vec3& a, const Vec3& b, double x, double y) {
            return (double(b.x()) - double(a.x())) * (y - double(a.y())) -
                   (double(b.y()) - double(a.y())) * (x - double(a.x()));
        };
        const double area = cross(p[0], p[1], double(p[2].x()), double(p[2].y()));
        if (area == 0) continue;
        const int left = int(std::min({p[0].x(), p[1].x(), p[2].x()})),
                  top = int(std::min({p[0].y(), p[1].y(), p[2].y()}));
        const int right = int(std::max({p[0].x(), p[1].x(), p[2].x()})),
                  bottom = int(std::max({p[0].y(), p[1].y(), p[2].y()}));
        for (int y = std::max(top, 0); y <= std::min(bottom, k_size - 1); ++y)
            for (int x = std::max(left, 0); x <= std::min(right, k_size - 1); ++x) {
                std::array<double, 3> w;
                for (std::size_t i = 0; i < 3; ++i)
                    w[i] = cross(p[(i + 1) % 3], p[(i + 2) % 3], x + 0.5, y + 0.5) / area;
                if (std::min({w[0], w[1], w[2]}) < 0) continue;
                float& depth = image.pixel(x, y)[0];
                depth = std::min(depth, static_cast<float>(w[0] * double(p[0].z()) + w[1] * double(p[1].z()) +
                                                           w[2] * double(p[2].z())));
            }
    }
    return image;
}

/// View-space depth of what Camera::project gives.
double linear_depth(const Camera& camera, float depth) {
    return double(camera.projection(2, 3)) / (double(depth) + double(camera.projection(2, 2)));
}

/// Whether a point of a drawing is in front of all pixels around it, or behind all; nothing if they do not agree.
std::optional<bool> is_in_front(const Scene& scene, const FloatImage& depths, const Vec2& at, float depth,
                                double slack) {
    const double own = linear_depth(scene.view.camera, depth);
    bool before = true, behind = true;
    for (int dy : {-1, 0, 1})
        for (int dx : {-1, 0, 1}) {
            const int x = int(std::floor(at.x())) + dx, y = int(std::floor(at.y())) + dy;
            if (x < 0 || y < 0 || x >= k_size || y >= k_size) return std::nullopt;
            const double there = linear_depth(scene.view.camera, depths.pixel(x, y)[0]);
            before = before && own < there + slack;
            behind = behind && own > there + slack;
        }
    return before == behind ? std::nullopt : std::optional(before);
}

struct HiddenLineErrors {
    double certain = 0, wrong = 0, hidden = 0;  // pixels of lines
};
void add_errors(const Scene& scene, const FloatImage& depths, const Drawing& drawing, double slack,
                HiddenLineErrors& errors) {
    for (const DrawingLayer& layer : drawing.layers)
        for (const Stroke& stroke : layer.strokes)
            for (std::size_t i = 0; i + 1 < stroke.points.size(); ++i) {
                const StrokePoint &a = stroke.points[i], &b = stroke.points[i + 1];
                const auto front =
                    is_in_front(scene, depths, 0.5f * (a.position + b.position), 0.5f * (a.depth + b.depth), slack);
                if (!front) continue;
                const double length = double((b.position - a.position).norm());
                errors.certain += length;
                errors.hidden += *front ? 0 : length;
                errors.wrong += *front != a.visible ? length : 0;
            }
}

TEST(Drawings, HideWhatAPictureOfDepthsHides) {
    DrawingStyle style = load_style("ink");
    HiddenLineErrors errors;
    for (const Vec3& direction : {Vec3(3, 2, 4), Vec3(-1, 4, 2), Vec3(2, -3, -3)}) {
        const Scene scene(knobbly(5), direction);
        const FloatImage depths = depth_picture(scene);
        // An edge is 0.03 long: contours lie so far behind the outline of the polygons.
        add_errors(scene, depths, draw(scene, style), 0.06, errors);
    }
    const Scene torus(shapes::torus(3, 1, 120, 40), {3, 1, 1});
    add_errors(torus, depth_picture(torus), draw(torus, style), 0.3, errors);
    const Scene boxes(
        shapes::joined(shapes::box(1, 1, 1, 4), shapes::translated(shapes::box(1, 2, 1, 2), {0.4f, 0, -3})));
    constexpr std::array k_edges = {LineType::creases, LineType::boundaries};
    add_errors(boxes, depth_picture(boxes), draw(boxes, style, k_edges), 0.02, errors);
    EXPECT_GT(errors.certain, 8000);
    EXPECT_GT(errors.hidden, 1500);
    EXPECT_LT(errors.wrong, 0.01 * errors.certain);
}

TEST(Drawings, KeepTheirLayersInOrder) {
    const Scene scene(knobbly(3));
    const Drawing drawing = draw(scene, load_style("ink"));
    ASSERT_EQ(drawing.layers.size(), k_line_types.size());
    for (std::size_t i = 0; i < drawing.layers.size(); ++i) EXPECT_EQ(drawing.layers[i].type, drawing_order()[i]);
    EXPECT_EQ(drawing.layers.back().type, LineType::contours);
    EXPECT_TRUE(draw(scene, load_style("ink"), {}).layers.empty());
}

TEST(Drawings, OfACutCubeHaveItsOutlineAndNothingElseAsContours) {
    const Scene cube(shapes::box(1, 1, 1, 3));
    DrawableSurface cut(cube.mesh.faces, cube.mesh.vertices);
    cut.take(cube.mesh.vertices, cube.normals, cube.curvature);
    const std::array types = {LineType::creases, LineType::contours, LineType::boundaries};
    const Drawing drawing = draw_lines(cut.surface(), types, load_style("technical"), cube.view);
    // Of a cube's nine visible edges six are its outline, three meet in front; three more are hidden.
    const auto visible = [](const DrawingLayer& layer) {
        std::size_t runs = 0;
        for (const Stroke& stroke : layer.strokes) runs += visible_runs(stroke).size();
        return runs;
    };
    ASSERT_EQ(drawing.layers.size(), 3);
    EXPECT_EQ(drawing.layers[0].type, LineType::creases);
    EXPECT_EQ(visible(drawing.layers[0]), 3);
    EXPECT_EQ(visible(drawing.layers[1]), 0);  // the cuts are no boundaries
    EXPECT_EQ(drawing.layers[2].type, LineType::contours);
    EXPECT_EQ(drawing.layers[2].segments, 6 * 3);
    EXPECT_EQ(visible(drawing.layers[2]), 1);  // around it, as at its corners two of them meet
}

TEST(VisibleRuns, AreWhatIsVisible) {
    Stroke stroke;
    for (int i = 0; i < 7; ++i) {
        stroke.points.emplace_back();
        stroke.points.back().position = Vec2(static_cast<float>(i), 0);
        stroke.points.back().parameter = static_cast<float>(i);
        stroke.points.back().visible = i != 2;
    }
    auto runs = visible_runs(stroke);
    ASSERT_EQ(runs.size(), 2);
    EXPECT_EQ(length_of(runs[0]), 2);
    EXPECT_EQ(length_of(runs[1]), 3);
    EXPECT_EQ(runs[1].points.front().parameter, 3);
    stroke.closed = true;  // the second run goes on in the first
    runs = visible_runs(stroke);
    ASSERT_EQ(runs.size(), 1);
    EXPECT_EQ(length_of(runs[0]), 5);
    EXPECT_FALSE(runs[0].closed);
    stroke.points[2].visible = true;
    runs = visible_runs(stroke);
    ASSERT_EQ(runs.size(), 1);
    EXPECT_TRUE(runs[0].closed);
    EXPECT_EQ(runs[0].points.size(), 7);
    for (StrokePoint& point : stroke.points) point.visible = false;
    EXPECT_TRUE(visible_runs(stroke).empty());
    EXPECT_TRUE(visible_runs({}).empty());
}

StrokeRun run_through(const std::vector<Vec2>& points, bool closed) {
    StrokeRun run;
    run.closed = closed;
    float parameter = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (i > 0) parameter += (points[i] - points[i - 1]).norm();
        run.points.emplace_back();
        run.points.back().position = points[i];
        run.points.back().parameter = parameter;
        run.points.back().width = points[i].x();
    }
    return run;
}

TEST(RunsWithinThePicture, EndAtItsBorder) {
    const auto runs = within_picture(run_through({{-10, 5}, {30, 5}, {30, 8}, {5, 8}}, false), 20, 10);
    ASSERT_EQ(runs.size(), 2);
    EXPECT_EQ(runs[0].points.front().position, Vec2(0, 5));
    EXPECT_EQ(runs[0].points.back().position, Vec2(20, 5));
    EXPECT_EQ(runs[0].points.back().width, 20);
    EXPECT_EQ(runs[0].points.front().parameter, 10);
    EXPECT_EQ(runs[1].points.front().position, Vec2(20, 8));
    EXPECT_EQ(runs[1].points.back().position, Vec2(5, 8));
    EXPECT_TRUE(within_picture(run_through({{-5, -3}, {30, -3}}, false), 20, 10).empty());
}

TEST(RunsWithinThePicture, StayClosedOrGoOnAcrossTheirStart) {
    const std::vector<Vec2> square = {{2, 2}, {8, 2}, {8, 8}, {2, 8}, {2, 2}};
    const auto whole = within_picture(run_through(square, true), 20, 10);
    ASSERT_EQ(whole.size(), 1);
    EXPECT_TRUE(whole[0].closed);
    EXPECT_EQ(whole[0].points.size(), 5);
    const auto cut = within_picture(run_through(square, true), 6, 10);
    ASSERT_EQ(cut.size(), 1);
    EXPECT_FALSE(cut[0].closed);
    EXPECT_EQ(cut[0].points.front().position, Vec2(6, 8));
    EXPECT_EQ(cut[0].points.back().position, Vec2(6, 2));
    for (std::size_t i = 1; i < cut[0].points.size(); ++i)
        EXPECT_GT(cut[0].points[i].parameter, cut[0].points[i - 1].parameter);
}

TEST(DrawingsSideBySide, KeepWhatBothShow) {
    Stroke stroke;
    stroke.points = {{.position = {1, 2}}, {.position = {3, 4}, .visible = false}};
    const Drawing one{.width = 10,
                      .height = 8,
                      .layers = {{LineType::ridges, 1, {stroke}}, {LineType::contours, 2, {stroke}}},
                      .seconds = {}};
    const Drawing both = side_by_side(one, one);
    EXPECT_EQ(both.width, 20);
    EXPECT_EQ(both.height, 8);
    ASSERT_EQ(both.layers.size(), 2u);
    EXPECT_EQ(both.layers[1].segments, 4u);
    ASSERT_EQ(both.layers[1].strokes.size(), 2u);
    EXPECT_EQ(both.layers[1].strokes[0].points[1].position, Vec2(3, 4));
    EXPECT_EQ(both.layers[1].strokes[1].points[1].position, Vec2(13, 4));
    EXPECT_FALSE(both.layers[1].strokes[1].points[1].visible);
}

TEST(DrawingsSideBySide, MustBeAlike) {
    const Drawing ridges{.width = 10, .height = 8, .layers = {{LineType::ridges, 0, {}}}, .seconds = {}};
    const Drawing contours{.width = 10, .height = 8, .layers = {{LineType::contours, 0, {}}}, .seconds = {}};
    const Drawing higher{.width = 10, .height = 9, .layers = {{LineType::ridges, 0, {}}}, .seconds = {}};
    EXPECT_THROW(side_by_side(ridges, contours), UsageError);
    EXPECT_THROW(side_by_side(ridges, higher), UsageError);
    EXPECT_THROW(side_by_side(ridges, {.width = 10, .height = 8, .layers = {}, .seconds = {}}), UsageError);
}

}  // namespace
}  // namespace exemplar
