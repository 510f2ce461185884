#include "host/lines/strokes/strokes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/core/errors.h"
#include "host/lines/extraction/drawable_surface.h"
#include "host/mesh/curvature/curvature_estimator.h"
#include "tests/support/shapes.h"

namespace exemplar {
namespace {

/// A row of faces in the plane z = 0 along x, with lines across it from side to side.
struct Ribbon {
    TriangleMesh mesh = shapes::grid(4, 1, 4);  // x and y in [0, 4]
    std::vector<Vec3> normals;
    VertexCurvature curvature;
    std::vector<FaceNeighbors> neighbors = build_face_neighbors(mesh.faces, mesh.vertices);
    std::vector<LineSegment> segments;
    std::vector<Chain> chains;
    StrokeView view;

    Ribbon() : normals(mesh.vertex_count(), Vec3::UnitZ()) {
        view.camera.view = look_at({2, 2, 10}, {2, 2, 0});
        view.camera.projection = orthographic(4, 1, 1, 20);  // 100 pixels a unit
        view.width = view.height = 800;
        // The line y = 2, face by face, as a zero set has it.
        for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
            LineSegment segment;
            segment.face = f;
            std::size_t ends = 0;
            for (std::size_t i = 0; i < 3; ++i) {
                const Vec3 &a = mesh.vertices[mesh.faces[f][i]], &b = mesh.vertices[mesh.faces[f][(i + 1) % 3]];
                if ((a.y() > 2) == (b.y() > 2)) continue;
                segment.places[ends] = static_cast<SegmentEnd>(i);
                segment.ends[ends][i] = segment.ends[ends][(i + 1) % 3] = 0.5f;
                segment.strength[ends] = 1;
                ++ends;
            }
            segments.push_back(segment);
        }
        chains = chain_segments(mesh.faces, neighbors, segments);
    }
    LineSurface surface() const { return {mesh.faces, mesh.vertices, normals, curvature, neighbors}; }
    std::vector<Stroke> strokes(const StrokeThickness& thickness, const VisibleParts* visible = nullptr) const {
        return make_strokes(surface(), LineType::ridges, segments, chains, visible, view, {}, thickness);
    }
    /// Of a straight chain: the visible parts of its segments that have x between the two.
    VisibleParts visible_between(float low, float high) const {
        VisibleParts parts;
        for (const LineSegment& segment : segments) {
            std::array<float, 2> x{};
            for (std::size_t e : {0, 1})
                for (std::size_t i = 0; i < 3; ++i)
                    x[e] += segment.ends[e][i] * mesh.vertices[mesh.faces[segment.face][i]].x();
            const auto at = [&](float wanted) { return std::clamp((wanted - x[0]) / (x[1] - x[0]), 0.0f, 1.0f); };
            VisiblePart part{at(low), at(high)};
            if (part.from > part.to) std::swap(part.from, part.to);
            if (part.from < part.to) parts.parts.push_back(part);
            parts.begin.push_back(static_cast<std::uint32_t>(parts.parts.size()));
        }
        return parts;
    }
};

TEST(Strokes, OfAStraightLineAreStraight) {
    const Ribbon ribbon;
    ASSERT_EQ(ribbon.chains.size(), 1);
    const auto strokes = ribbon.strokes({.width = 3, .epsilon = 1, .least = 0, .most = 9, .taper = 0});
    ASSERT_EQ(strokes.size(), 1);
    const auto& points = strokes[0].points;
    ASSERT_EQ(points.size(), 9);
    EXPECT_FALSE(strokes[0].closed);
    const float way = points.back().position.x() > points.front().position.x() ? 1.0f : -1.0f;
    for (std::size_t i = 0; i < points.size(); ++i) {
        EXPECT_NEAR(points[i].position.y(), 400, 1e-3);
        EXPECT_NEAR(std::abs(points[i].position.x() - points.front().position.x()), points[i].parameter, 1e-3);
        // On the right of the way on, where y points down: to the right is downward.
        EXPECT_NEAR((points[i].normal - Vec2(0, way)).norm(), 0, 1e-5);
        EXPECT_NEAR(points[i].width, 3, 1e-5);
        EXPECT_NEAR(points[i].depth, 9.0 / 19, 1e-5);
        EXPECT_TRUE(points[i].visible);
        EXPECT_NEAR(points[i].opacity, 0.9f / (0.9f + 0.1f), 1e-5);
    }
    EXPECT_NEAR(points.back().parameter, 400, 1e-2);
}

TEST(Strokes, TaperTowardsTheirEnds) {
    const Ribbon ribbon;
    const auto points = ribbon.strokes({.width = 4, .epsilon = 1, .least = 1, .most = 9, .taper = 100})[0].points;
    EXPECT_EQ(points.front().width, 0);
    EXPECT_EQ(points.back().width, 0);
    for (const StrokePoint& point : points) {
        const float distance = std::min(point.parameter, points.back().parameter - point.parameter);
        const float x = std::min(1.0f, distance / 100);
        EXPECT_NEAR(point.width, 4 * std::sqrt(1 - (1 - x) * (1 - x)), 1e-2);
    }
}

TEST(Strokes, AreThinWhereTheyTurnBack) {
    Ribbon ribbon;
    for (Vec3& v : ribbon.mesh.vertices)
        if (v.x() > 2) v = Vec3(4 - v.x(), v.y(), -0.1f);
    const auto width_at_fold = [&](float taper) {
        const auto points = ribbon.strokes({.width = 4, .epsilon = 1, .least = 0, .most = 9, .taper = taper})[0].points;
        const auto fold = std::max_element(
            points.begin(), points.end(), [](const auto& a, const auto& b) { return a.position.x() < b.position.x(); });
        EXPECT_NEAR(std::prev(fold, 3)->width, 4, 1e-4);
        return fold->width;
    };
    EXPECT_NEAR(width_at_fold(1), 0, 1e-3);
    EXPECT_NEAR(width_at_fold(0), 4, 1e-3);  // strokes that do not taper are even
}

TEST(Strokes, OfContoursKeepTheirWidthWhereTheyEndOnSharpEdges) {
    const TriangleMesh can = shapes::cylinder(1, 2, 24, 3, true);
    DrawableSurface cut(can.faces, can.vertices);
    cut.measure(can.vertices);
    const LineSurface surface = cut.surface();
    StrokeView view{
        .camera = fit_camera(can, {3, 2, 4}, 1), .width = 400, .height = 400, .unit_depth = 10, .feature_size = 1};
    LineOptions options;
    options.eye = view.camera.position();
    const std::vector<LineSegment> segments = extract_lines(surface, LineType::contours, options);
    const std::vector<Chain> chains = chain_segments(surface.joined_faces(), surface.neighbors, segments, false);
    const std::vector<Stroke> strokes =
        make_strokes(surface, LineType::contours, segments, chains, nullptr, view, {}, {.taper = 40});
    std::size_t across = 0;
    for (std::size_t i = 0; i < chains.size(); ++i) {
        if (runs_along_edge(LineType::contours, segments[chains[i].links[0].segment])) continue;
        ++across;
        for (const StrokePoint& point : strokes[i].points) EXPECT_GT(point.width, 0.5f);
    }
    EXPECT_EQ(across, 2);
}

TEST(Strokes, HavePointsWhereVisibilityChanges) {
    const Ribbon ribbon;
    const VisibleParts parts = ribbon.visible_between(1.23f, 2.87f);
    const auto points =
        ribbon.strokes({.width = 4, .epsilon = 1, .least = 1, .most = 9, .taper = 50}, &parts)[0].points;
    ASSERT_EQ(points.size(), 1 + 8 * 5 + 2);
    float visible = 0;
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
        const float x = points[i].position.x(), next = points[i + 1].position.x();
        EXPECT_GT(points[i + 1].parameter, points[i].parameter);
        EXPECT_NEAR(points[i].normal.norm(), 1, 1e-5);
        const float middle = 0.5f * (x + next) / 100 - 2;
        EXPECT_EQ(points[i].visible, middle > 1.23f && middle < 2.87f) << middle;
        if (points[i].visible) visible += std::abs(next - x);
        const float distance = std::min(std::abs(x - 323), std::abs(x - 487));
        const bool inside = x > 323 && x < 487;
        EXPECT_NEAR(points[i].width, inside ? 4 * stroke_taper(distance, 50) : 0, 0.05);
    }
    EXPECT_NEAR(visible, 164, 0.01);
    const VisibleParts none = ribbon.visible_between(7, 8), all = ribbon.visible_between(-1, 8);
    for (const Stroke& stroke : ribbon.strokes({}, &none))
        for (const StrokePoint& point : stroke.points) EXPECT_FALSE(point.visible);
    EXPECT_EQ(ribbon.strokes({.taper = 0}, &all)[0].points.size(), 9);
}

/// A ball's contour seen in parallel is a circle.
struct Ball {
    TriangleMesh mesh = shapes::icosphere(4, 1);
    std::vector<Vec3> normals;
    VertexCurvature curvature;
    std::vector<FaceNeighbors> neighbors = build_face_neighbors(mesh.faces, mesh.vertices);
    std::vector<LineSegment> segments;
    std::vector<Chain> chains;
    StrokeView view;

    Ball() {
        for (const Vec3& p : mesh.vertices) normals.push_back(p.normalized());
        view.camera.view = look_at(Vec3(3, 5, 8), {0, 0, 0});
        view.camera.projection = orthographic(2, 1, 1, 20);
        view.width = view.height = 400;
        LineOptions options;
        options.parallel_eye = true;
        options.eye = Vec3(3, 5, 8).normalized();
        segments = extract_lines(surface(), LineType::contours, options);
        chains = chain_segments(mesh.faces, neighbors, segments);
    }
    LineSurface surface() const { return {mesh.faces, mesh.vertices, normals, curvature, neighbors}; }
    Stroke stroke(const StrokeThickness& thickness, const VisibleParts* visible = nullptr) const {
        EXPECT_EQ(chains.size(), 1);
        return make_strokes(surface(), LineType::contours, segments, chains, visible, view, {}, thickness).at(0);
    }
};

TEST(Strokes, OfABallsContourRunAroundIt) {
    const Ball ball;
    const Stroke stroke = ball.stroke({});
    EXPECT_TRUE(stroke.closed);
    ASSERT_GT(stroke.points.size(), ball.segments.size());
    const StrokePoint &first = stroke.points.front(), &last = stroke.points.back();
    EXPECT_EQ(first.position, last.position);
    EXPECT_EQ(first.normal, last.normal);
    EXPECT_NEAR(last.parameter, 2 * std::numbers::pi * 100, 6);
    for (const StrokePoint& point : stroke.points) {
        const Vec2 outward = (point.position - Vec2(200, 200)).normalized();
        // What faces the eye, the inside, is to the left of contours.
        EXPECT_GT(point.normal.dot(outward), 0.9f);
        EXPECT_NEAR((point.position - Vec2(200, 200)).norm(), 100, 1);
        EXPECT_NEAR(point.width, 2.5, 1e-5);  // no taper where there is no end
        EXPECT_EQ(point.opacity, 1);
    }
}

TEST(Strokes, RunOverTheStartOfAClosedChain) {
    const Ball ball;
    // All is visible but a few segments half way around.
    const std::size_t count = ball.segments.size();
    std::vector<bool> hidden(count, false);
    for (std::size_t i = count / 2; i < count / 2 + 3; ++i) hidden[ball.chains[0].links[i].segment] = true;
    VisibleParts parts;
    for (std::size_t s = 0; s < count; ++s) {
        if (!hidden[s]) parts.parts.push_back({});
        parts.begin.push_back(static_cast<std::uint32_t>(parts.parts.size()));
    }
    const Stroke stroke = ball.stroke({.width = 5, .epsilon = 1, .least = 1, .most = 9, .taper = 40}, &parts);
    const auto& points = stroke.points;
    EXPECT_EQ(points.front().width, 5);
    EXPECT_EQ(points.back().width, 5);
    const float begins = points[count / 2 + 3].parameter, ends = points[count / 2].parameter;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const float behind = points[i].parameter - begins, ahead = ends - points[i].parameter;
        const float total = points.back().parameter;
        const float nearest = std::min(behind >= 0 ? behind : behind + total, ahead >= 0 ? ahead : ahead + total);
        const bool inside = i > count / 2 && i < count / 2 + 3;
        EXPECT_NEAR(points[i].width, inside ? 0 : 5 * stroke_taper(nearest, 40), 1e-3) << i;
    }
}

TEST(Strokes, AreThinWhereTheSurfaceBendsAndFarAway) {
    Ball ball;
    const std::size_t count = ball.mesh.vertex_count();
    ball.curvature.k1.assign(count, 2);
    ball.curvature.k2.assign(count, 2);
    ball.curvature.e1.resize(count);
    ball.curvature.e2.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
        ball.curvature.e1[i] = ball.normals[i].unitOrthogonal();
        ball.curvature.e2[i] = ball.normals[i].cross(ball.curvature.e1[i]);
    }
    ball.view.feature_size = 0.25f;
    const StrokeThickness thickness{.width = 6, .epsilon = 0.5f, .least = 0.1f, .most = 8, .taper = 0};
    for (const StrokePoint& point : ball.stroke(thickness).points) EXPECT_NEAR(point.width, 3, 1e-4);
    // Hollow is as flat.
    for (float& k : ball.curvature.k1) k = -2;
    for (float& k : ball.curvature.k2) k = -2;
    for (const StrokePoint& point : ball.stroke(thickness).points) EXPECT_NEAR(point.width, 6, 1e-4);
    // In perspective, twice as far is half as wide, within bounds.
    const float distance = Vec3(3, 5, 8).norm();
    ball.view.camera.projection = perspective(0.5f, 1, 1, 20);
    for (const auto& [unit, width] :
         {std::pair(distance, 6.0f), {0.5f * distance, 3.0f}, {4 * distance, 8.0f}, {0.01f * distance, 0.1f}}) {
        ball.view.unit_depth = unit;
        for (const StrokePoint& point : ball.stroke(thickness).points) EXPECT_NEAR(point.width, width, 0.05);
    }
}

TEST(Strokes, TakeRadialCurvatureAlongTheView) {
    // A line on a plane that claims to bend by 3 along x and 1 along y, seen from aside.
    Ribbon ribbon;
    const std::size_t count = ribbon.mesh.vertex_count();
    ribbon.curvature.k1.assign(count, 3);
    ribbon.curvature.k2.assign(count, 1);
    ribbon.curvature.e1.assign(count, Vec3::UnitX());
    ribbon.curvature.e2.assign(count, Vec3::UnitY());
    const StrokeThickness thickness{.width = 8, .epsilon = 1, .least = 0, .most = 9, .taper = 0};
    const auto width = [&](const Vec3& eye) {
        ribbon.view.camera.view = look_at(Vec3(2, 2, 0) + eye, {2, 2, 0});
        return ribbon.strokes(thickness)[0].points[4].width;
    };
    EXPECT_NEAR(width({5, 0, 5}), 8 / (3.0 + 1), 1e-4);
    EXPECT_NEAR(width({0, 5, 5}), 8 / (1.0 + 1), 1e-4);
    EXPECT_NEAR(width({4, 4, 5}), 8 / (2.0 + 1), 1e-4);
    EXPECT_NEAR(width({0, 0, 9}), 8 / (2.0 + 1), 1e-4);  // along the normal: the mean
}

TEST(Strokes, OfPointsBehindTheEyeAreStillFinite) {
    Ribbon ribbon;
    ribbon.view.camera.view = look_at({2, 2, 0}, {3, 2, 0});  // an eye on the line itself
    ribbon.view.camera.projection = perspective(0.5f, 1, 0.1f, 20);
    const auto strokes = ribbon.strokes({});
    for (const StrokePoint& point : strokes.at(0).points) {
        EXPECT_TRUE(point.position.allFinite());
        EXPECT_TRUE(std::isfinite(point.parameter) && std::isfinite(point.width));
        EXPECT_NEAR(point.normal.norm(), 1, 1e-4);
    }
}

TEST(Strokes, RefuseWhatDoesNotFit) {
    Ribbon ribbon;
    for (const StrokeThickness& wrong :
         {StrokeThickness{.width = 0}, StrokeThickness{.epsilon = -1}, StrokeThickness{.least = 7, .most = 6},
          StrokeThickness{.taper = -1}, StrokeThickness{.width = std::nanf("")}, StrokeThickness{.most = HUGE_VALF}})
        EXPECT_THROW(ribbon.strokes(wrong), UsageError);
    const VisibleParts none;
    EXPECT_THROW(ribbon.strokes({}, &none), UsageError);
    Ribbon curved = ribbon;
    curved.curvature.k1.resize(3);
    EXPECT_THROW(curved.strokes({}), UsageError);
    Ribbon flat = ribbon;
    flat.view.height = 0;
    EXPECT_THROW(flat.strokes({}), UsageError);
    ribbon.chains[0].links[0].segment = 100;
    EXPECT_THROW(ribbon.strokes({}), UsageError);
}

}  // namespace
}  // namespace exemplar
