// Strokes that stay on a surface while it, or the eye, moves.

#include "host/hatching/animation/advected_strokes.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <vector>

#include "host/core/errors.h"
#include "host/hatching/animation/hatching_flicker.h"
#include "host/hatching/features/hatching_surface.h"
#include "host/hatching/placement/streamlines.h"
#include "tests/support/shapes.h"

namespace exemplar {
namespace {

constexpr int k_frame_width = 120, k_frame_height = 90;

/// Parallel: 10 pixels are a unit, and the point (0, 0, z) is in the middle.
HatchingView flat_view() {
    HatchingView view;
    view.camera.view = look_at({0, 0, 10}, {0, 0, 0});
    view.camera.projection = orthographic(4.5f, static_cast<float>(k_frame_width) / k_frame_height, 1, 20);
    view.width = k_frame_width;
    view.height = k_frame_height;
    return view;
}
Vec2 pixel_at(float x, float y) {
    return {60 + 10 * x, 45 - 10 * y};
}

TriangleMesh rectangle(const Vec3& low, const Vec3& high) {
    TriangleMesh mesh;
    mesh.vertices = {{low.x(), low.y(), low.z()},
                     {high.x(), low.y(), low.z()},
                     {high.x(), high.y(), low.z()},
                     {low.x(), high.y(), low.z()}};
    mesh.faces = {{0, 1, 2}, {0, 2, 3}};
    return mesh;
}

HatchStroke line_in_layer(const Vec2& from, const Vec2& to, std::size_t layer = 0) {
    HatchStroke stroke{.layer = layer, .points = {}, .widths = {}};
    const int pieces = static_cast<int>(std::ceil((to - from).norm() / 2));
    for (int i = 0; i <= pieces; ++i)
        stroke.points.emplace_back(from + static_cast<float>(i) / static_cast<float>(pieces) * (to - from));
    stroke.widths.assign(stroke.points.size(), 1.0f);
    return stroke;
}

std::vector<AdvectedStroke> carry(const std::vector<HatchStroke>& strokes, const TriangleMesh& before,
                                  const HatchingView& then, const TriangleMesh& after, const HatchingView& now) {
    const auto on_surface =
        strokes_on_surface(strokes, before, then, render_gbuffer(before, then.camera, then.width, then.height));
    return advected_strokes(on_surface, after, now, render_gbuffer(after, now.camera, now.width, now.height));
}

TEST(CarriedStrokes, MoveWithAPlane) {
    const TriangleMesh before = rectangle({-4, -3, 0}, {4, 3, 0});
    const TriangleMesh after = shapes::translated(before, Vec3(0.53f, -0.27f, 1.5f));
    const std::vector<HatchStroke> strokes{line_in_layer({30.3f, 50.2f}, {60.9f, 30.7f}),
                                           line_in_layer({70, 40}, {70, 61.6f}, 1)};
    const std::vector<AdvectedStroke> carried = carry(strokes, before, flat_view(), after, flat_view());
    ASSERT_EQ(carried.size(), 2u);
    for (std::size_t s = 0; s < 2; ++s) {
        const HatchStroke& stroke = carried[s].stroke;
        EXPECT_EQ(stroke.layer, s);
        EXPECT_TRUE(carried[s].is_whole[0] && carried[s].is_whole[1]);
        ASSERT_EQ(stroke.points.size(), strokes[s].points.size());
        // What floats round; the last point may be half a step farther.
        for (std::size_t i = 0; i + 1 < stroke.points.size(); ++i)
            EXPECT_LT((stroke.points[i] - strokes[s].points[i] - Vec2(5.3f, 2.7f)).norm(), 1e-3f);
        const float longer = (stroke.points.back() - strokes[s].points.back() - Vec2(5.3f, 2.7f)).norm();
        EXPECT_LT(longer, 0.52f);
    }
}

TEST(CarriedStrokes, MoveWithATurningSphere) {
    // Fine enough that the sphere and its faces differ by a tenth of a pixel at most.
    constexpr float k_radius = 2, k_angle = 0.3f;
    const TriangleMesh before = shapes::icosphere(5, k_radius);
    const Eigen::Matrix3f turn = Eigen::AngleAxisf(k_angle, Vec3(1, 2, 0.5f).normalized()).toRotationMatrix();
    const TriangleMesh after = shapes::rotated(before, turn);
    HatchingView view;
    view.camera.view = look_at({3, 4, 9}, {0, 0, 0});
    view.camera.projection = perspective(0.45f, static_cast<float>(k_frame_width) / k_frame_height, 5, 16);
    view.width = k_frame_width;
    view.height = k_frame_height;
    const HatchStroke stroke = line_in_layer({42.3f, 30.1f}, {77.7f, 58.9f});
    const std::vector<AdvectedStroke> carried = carry({stroke}, before, view, after, view);
    ASSERT_EQ(carried.size(), 1u);
    ASSERT_EQ(carried[0].stroke.points.size(), stroke.points.size());
    const Eigen::Matrix4f back = view.camera.view_projection().inverse();
    const Vec3 eye = view.camera.position();
    for (std::size_t i = 0; i + 1 < stroke.points.size(); ++i) {
        const Vec2& p = stroke.points[i];
        const Eigen::Vector4f far =
            back * Eigen::Vector4f(2 * p.x() / k_frame_width - 1, 2 * p.y() / k_frame_height - 1, 1, 1);
        const Vec3 ray = (far.head<3>() / far.w() - eye).normalized();
        const float along = ray.dot(eye), under = along * along - eye.squaredNorm() + k_radius * k_radius;
        ASSERT_GT(under, 0);
        const Vec3 hit = eye - (along + std::sqrt(under)) * ray;
        const Vec3 expected = view.camera.project(turn * hit, k_frame_width, k_frame_height);
        EXPECT_LT((carried[0].stroke.points[i] - expected.head<2>()).norm(), 0.1f) << i;
    }
}

TEST(CarriedStrokes, EndWhereTheyTurnAway) {
    const TriangleMesh sphere = shapes::icosphere(4, 4);
    const TriangleMesh after = shapes::rotated(sphere, Eigen::AngleAxisf(0.6f, Vec3::UnitY()).toRotationMatrix());
    // Along the equator from the left to near the right end, which the turn takes away.
    const HatchStroke stroke = line_in_layer({30, 45}, {97, 45});
    const std::vector<AdvectedStroke> carried = carry({stroke}, sphere, flat_view(), after, flat_view());
    ASSERT_EQ(carried.size(), 1u);
    EXPECT_TRUE(carried[0].is_whole[0]);
    EXPECT_FALSE(carried[0].is_whole[1]);
    // It has come to the horizon, 40 pixels from the middle, within a point or so.
    EXPECT_NEAR(carried[0].stroke.points.back().x(), 100, 2);
    const float from = std::asin(-30.0f / 40) + 0.6f;
    EXPECT_NEAR(carried[0].stroke.points.front().x(), 60 + 40 * std::sin(from), 0.2f);
}

TEST(CarriedStrokes, AreHiddenByWhatComesBeforeThem) {
    const TriangleMesh wall = rectangle({-4, -3, 0}, {4, 3, 0});
    const TriangleMesh before = shapes::joined(wall, rectangle({-1, -1, -2}, {1, 1, -2}));
    const TriangleMesh after = shapes::joined(wall, rectangle({-1, -1, 2}, {1, 1, 2}));
    const HatchStroke stroke = line_in_layer(pixel_at(-3, 0.2f), pixel_at(3, 0.2f));
    const std::vector<AdvectedStroke> carried = carry({stroke}, before, flat_view(), after, flat_view());
    ASSERT_EQ(carried.size(), 2u);
    EXPECT_TRUE(carried[0].is_whole[0] && !carried[0].is_whole[1]);
    EXPECT_TRUE(!carried[1].is_whole[0] && carried[1].is_whole[1]);
    // Points are two pixels apart, and borders of what hides them count as seen.
    EXPECT_NEAR(carried[0].stroke.points.back().x(), 50, 3.1f);
    EXPECT_NEAR(carried[1].stroke.points.front().x(), 70, 3.1f);
}

TEST(CarriedStrokes, LeaveThePictureAndTear) {
    const TriangleMesh left = rectangle({-4, -3, 0}, {0, 3, 0});
    const TriangleMesh before = shapes::joined(left, rectangle({0, -3, 0}, {4, 3, 0}));
    // The right half moves away, and stretches.
    const TriangleMesh after = shapes::joined(left, rectangle({2, -3, 0}, {7, 3, 0}));
    const HatchStroke stroke = line_in_layer(pixel_at(-2, 0.2f), pixel_at(3.5f, 0.2f));
    const std::vector<AdvectedStroke> carried = carry({stroke}, before, flat_view(), after, flat_view());
    ASSERT_EQ(carried.size(), 2u);
    EXPECT_LE(carried[0].stroke.points.back().x(), 60.6f);
    EXPECT_GE(carried[1].stroke.points.front().x(), 80);
    EXPECT_FALSE(carried[1].is_whole[1]);
    EXPECT_LT(carried[1].stroke.points.back().x(), 120.6f);
}

TEST(CarriedStrokes, RefuseWhatDoesNotFit) {
    const TriangleMesh mesh = rectangle({-4, -3, 0}, {4, 3, 0});
    const HatchingView view = flat_view();
    const std::vector<HatchStroke> strokes{line_in_layer({30, 50}, {60, 30})};
    const GBuffer small = render_gbuffer(mesh, view.camera, 20, 20);
    EXPECT_THROW(strokes_on_surface(strokes, mesh, view, small), UsageError);
    const GBuffer gbuffer = render_gbuffer(mesh, view.camera, k_frame_width, k_frame_height);
    auto places = strokes_on_surface(strokes, mesh, view, gbuffer);
    EXPECT_THROW(advected_strokes(places, mesh, view, small), UsageError);
    places[0].places[3].face = 2;
    EXPECT_THROW(advected_strokes(places, mesh, view, gbuffer), UsageError);
}

TEST(CarriedStrokes, StayAsTheyAreInAStillPicture) {
    const TriangleMesh mesh = rectangle({-5, -4, 0}, {5, 4, 0});
    const HatchingView view = flat_view();
    const GBuffer gbuffer = render_gbuffer(mesh, view.camera, k_frame_width, k_frame_height);
    HatchingFields fields(k_frame_width, k_frame_height);
    for (std::size_t i = 0; i < fields.size(); ++i) {
        const bool covered = gbuffer.face[i] != k_no_face;
        fields.level[i] = covered ? k_single_hatching : k_no_hatching;
        const float x = static_cast<float>(i % k_frame_width) / k_frame_width;
        fields.orientation[0][i] = 0.3f + x;
        fields.thickness[i] = fields.intensity[i] = 1;
        fields.spacing[i] = 5;
        fields.length[i] = 30;
    }
    CpuStrokePlacer placer;
    const std::vector<HatchStroke> first = placer.place(fields);
    std::vector<HatchStroke> strokes = first;
    for (int picture = 0; picture < 20; ++picture) {
        const std::vector<AdvectedStroke> carried = carry(strokes, mesh, view, mesh, view);
        std::vector<HatchStroke> kept;
        kept.reserve(carried.size());
        for (const AdvectedStroke& one : carried) kept.push_back(one.stroke);
        strokes = placer.place(fields, {}, {}, kept);
        const HatchingFlicker flicker = measure_flicker(strokes, carried);
        EXPECT_LT(flicker.appeared, 0.02f);
        EXPECT_LT(flicker.vanished, 0.02f);
        EXPECT_LT(flicker.slip, 0.6f);
    }
    // They have not worn off either.
    std::vector<AdvectedStroke> beginning;
    beginning.reserve(first.size());
    for (const HatchStroke& stroke : first) beginning.push_back({stroke, {true, true}});
    const HatchingFlicker all = measure_flicker(strokes, beginning);
    EXPECT_LT(all.vanished, 0.1f);
    EXPECT_LT(all.slip, 1);
}

TEST(HatchingFlicker, IsTheShareThatIsElsewhere) {
    const std::vector<HatchStroke> strokes{line_in_layer({10, 10}, {50, 10}), line_in_layer({10, 20}, {50, 20}),
                                           line_in_layer({10, 40}, {50, 40}, 1)};
    std::vector<AdvectedStroke> before;
    before.reserve(strokes.size());
    for (const HatchStroke& stroke : strokes) before.push_back({stroke, {true, true}});
    const HatchingFlicker same = measure_flicker(strokes, before);
    EXPECT_FLOAT_EQ(same.drawn, 120);
    EXPECT_EQ(same.appeared, 0);
    EXPECT_EQ(same.vanished, 0);
    EXPECT_EQ(same.slip, 0);
    before[0].stroke = line_in_layer({10, 10}, {30, 10});           // half of it is new, and an end 20 pixels away
    before[2].stroke = line_in_layer({10, 40.6f}, {50, 40.6f}, 1);  // farther than half a pixel
    before[1].is_whole = {false, false};
    const HatchingFlicker other = measure_flicker(strokes, before);
    EXPECT_NEAR(other.appeared, 60.0f / 120, 0.01f);
    EXPECT_NEAR(other.vanished, 40.0f / 100, 0.01f);
    EXPECT_NEAR(other.slip, (20 + 2 * 0.6f) / 4, 0.01f);
    before[2].stroke.layer = 0;  // another layer is elsewhere
    EXPECT_NEAR(measure_flicker(strokes, before).appeared, 60.0f / 120, 0.01f);
    EXPECT_EQ(measure_flicker({}, {}).appeared, 0);
    const HatchingFlicker mean = mean_flicker(std::vector<HatchingFlicker>{{100, 0.1f, 0.2f, 1}, {300, 0.5f, 0.6f, 2}});
    EXPECT_FLOAT_EQ(mean.drawn, 200);
    EXPECT_FLOAT_EQ(mean.appeared, 0.4f);
    EXPECT_FLOAT_EQ(mean.vanished, 0.5f);
    EXPECT_FLOAT_EQ(mean.slip, 1.75f);
}

// A surface that only turns is measured as it was, turned.
TEST(MovedSurface, TurnsWithWhatItIs) {
    TriangleMesh mesh = shapes::icosphere(3, 1);
    for (Vec3& vertex : mesh.vertices)
        vertex = Vec3(1.7f * vertex.x(), vertex.y() * (1 + 0.2f * vertex.x()), 0.6f * vertex.z());
    HatchingSurface surface = measure_surface(mesh);
    const HatchingSurface before = surface;
    const Eigen::Matrix3f turn = Eigen::AngleAxisf(1.1f, Vec3(1, -2, 0.5f).normalized()).toRotationMatrix();
    std::vector<Vec3> vertices;
    for (const Vec3& vertex : mesh.vertices) vertices.emplace_back(turn * vertex);
    move_surface(surface, vertices);
    EXPECT_EQ(surface.mesh.vertices, vertices);
    EXPECT_EQ(surface.descriptors.values, before.descriptors.values);
    const auto along = [&](const Vec3& now, const Vec3& then) { return std::abs(now.dot(turn * then)); };
    std::size_t same_bending = 0;
    for (std::size_t v = 0; v < vertices.size(); ++v) {
        EXPECT_GT(surface.normals[v].dot(turn * before.normals[v]), 0.9999f);
        EXPECT_NEAR(surface.curvature[1].k1[v], before.curvature[1].k1[v], 0.01f);
        EXPECT_NEAR(surface.occlusion.ambient[v], before.occlusion.ambient[v], 0.02f);
        for (std::size_t s = 0; s < 3; ++s)
            EXPECT_GT(along(surface.directions.e_a[s][v], before.directions.e_a[s][v]), 0.999f);
        same_bending += along(surface.directions.k_max[1][v], before.directions.k_max[1][v]) > 0.99f;
    }
    // But for where the surface bends alike in all directions.
    EXPECT_GT(same_bending, vertices.size() * 9 / 10);
}

TEST(MovedSurface, RefusesOtherVertices) {
    HatchingSurface surface = measure_surface(shapes::icosphere(2, 1));
    std::vector<Vec3> vertices = surface.mesh.vertices;
    vertices[3].x() = std::numeric_limits<float>::infinity();
    EXPECT_THROW(move_surface(surface, vertices), MeshError);
    vertices.pop_back();
    EXPECT_THROW(move_surface(surface, vertices), UsageError);
}

}  // namespace
}  // namespace exemplar
