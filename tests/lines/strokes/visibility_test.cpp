#include "host/lines/strokes/visibility.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "host/core/errors.h"
#include "host/core/parallel.h"
#include "tests/lines/extraction/measured_surface.h"
#include "tests/support/shapes.h"

namespace exemplar {
namespace {

struct Scene : test_support::MeasuredSurface {
    using MeasuredSurface::MeasuredSurface;

    Vec3 at(const LineSegment& segment, float t) const {
        Vec3 point = Vec3::Zero();
        for (std::size_t i = 0; i < 3; ++i)
            point += (segment.ends[0][i] + t * (segment.ends[1][i] - segment.ends[0][i])) *
                     mesh.vertices[mesh.faces[segment.face][i]];
        return point;
    }
};

constexpr int k_size = 600;

Camera camera_at(const Vec3& eye, const Vec3& target = Vec3::Zero()) {
    Camera camera;
    camera.view = look_at(eye, target);
    camera.projection = perspective(0.5f, 1, 0.05f * eye.norm(), 10 * eye.norm());
    return camera;
}

std::vector<LineSegment> lines(const Scene& scene, LineType type, const Camera& camera) {
    LineOptions options;
    options.eye = camera.position();
    options.feature_size = 0.1f;
    return extract_lines(scene.surface(), type, options);
}

/// Lengths of lines in the picture, in pixels: whose visibility is known, is told wrongly, and is visible.
struct Comparison {
    double known = 0, wrong = 0, visible = 0;
};

/// Compares, at points along the lines, with the truth: 1 visible, 0 hidden, nothing where the truth is not certain.
Comparison compare(const Scene& scene, LineType type, const Camera& camera,
                   const std::function<std::optional<bool>(const Vec3d&)>& truth) {
    const auto segments = lines(scene, type, camera);
    const VisibleParts parts = LineVisibility(scene.surface()).visible_parts(type, segments, camera, k_size, k_size);
    EXPECT_EQ(parts.segment_count(), segments.size());
    Comparison result;
    constexpr int k_points = 4;
    for (std::size_t s = 0; s < segments.size(); ++s) {
        const auto on_screen = [&](float t) { return camera.project(scene.at(segments[s], t), k_size, k_size); };
        const double length = double((on_screen(1) - on_screen(0)).head<2>().norm()) / k_points;
        for (int i = 0; i < k_points; ++i) {
            const float t = (static_cast<float>(i) + 0.5f) / k_points;
            const auto expected = truth(scene.at(segments[s], t).cast<double>());
            if (!expected) continue;
            bool seen = false;
            for (const VisiblePart& part : parts.of(s)) seen = seen || (part.from <= t && t <= part.to);
            result.known += length;
            result.visible += *expected ? length : 0;
            result.wrong += seen != *expected ? length : 0;
        }
    }
    return result;
}

using Inside = std::function<double(const Vec3d&)>;  // negative inside a body, its size about the distance

/// Whether the smooth body of `inside` lets an eye see its contour at (about) p; nothing if it is a close thing. The
/// first `skip` of the ray is not looked at: there the point is on the surface.
std::optional<bool> sees(const Inside& inside, const Vec3d& p, const Vec3d& eye, double skip, double unclear) {
    const Vec3d way = eye - p;
    double deepest = 1e9;
    for (int i = 0; i < 1500; ++i) {
        const double distance = skip + (way.norm() - skip) * i / 1500;
        deepest = std::min(deepest, inside(p + way.normalized() * distance));
    }
    if (std::abs(deepest) < unclear) return std::nullopt;
    return deepest > 0;
}

double torus_distance(const Vec3d& p) {
    return std::hypot(std::hypot(p.x(), p.y()) - 3, p.z()) - 1;
}

/// Radial curvature of a contour at p by differences: a contour that is not positive is hidden by its own surface.
double bend_along(const Inside& inside, const Vec3d& p, const Vec3d& eye) {
    constexpr double k_step = 0.02;
    const Vec3d step = (eye - p).normalized() * k_step;
    return inside(p + step) + inside(p - step) - 2 * inside(p);
}

void expect_right_contours(const Scene& scene, const Inside& inside, const Vec3& eye, double min_length,
                           double most_wrong) {
    const Camera camera = camera_at(eye);
    const Comparison found = compare(scene, LineType::contours, camera, [&](const Vec3d& p) -> std::optional<bool> {
        const double bend = bend_along(inside, p, eye.cast<double>());
        if (std::abs(bend) < 2e-5) return std::nullopt;  // about a cusp
        if (bend < 0) return false;
        return sees(inside, p, eye.cast<double>(), 0.25, 0.02);
    });
    EXPECT_GT(found.known, min_length) << eye.transpose();
    EXPECT_GT(found.visible, 0.5 * min_length) << eye.transpose();
    EXPECT_LT(found.wrong, most_wrong * found.known) << eye.transpose();
}

TEST(Visibility, OfATorusContoursIsThatOfTheSmoothTorus) {
    for (const std::uint32_t n : {20u, 40u, 80u}) {
        const Scene scene(shapes::torus(3, 1, 3 * n, n));
        for (const Vec3& eye : {Vec3(20, 2, 4), Vec3(3, -20, 5), Vec3(1, 2, 20), Vec3(12, 9, 9)})
            expect_right_contours(scene, torus_distance, eye, 300, n < 40 ? 0.03 : 0.01);
    }
}

double bumpy_radius(const Vec3d& u) {
    return 1 + 0.2 * std::sin(3 * u.x() + 1) + 0.15 * u.y() * std::cos(4 * u.z()) + 0.1 * std::sin(5 * u.y());
}
double bumpy_distance(const Vec3d& p) {
    return p.norm() - bumpy_radius(p.normalized());
}
TriangleMesh bumpy(int subdivisions) {
    return shapes::transformed(shapes::icosphere(subdivisions, 1), [](const Vec3& p) -> Vec3 {
        return (p.cast<double>() * bumpy_radius(p.cast<double>())).cast<float>();
    });
}

TEST(Visibility, OfABumpySpheresContoursIsThatOfTheSmoothOne) {
    for (const int subdivisions : {4, 5}) {
        const Scene scene(bumpy(subdivisions));
        for (const Vec3& eye : {Vec3(6, 2, 4), Vec3(3, -6, 5), Vec3(1, 2, 8), Vec3(-4, 5, -3)})
            expect_right_contours(scene, bumpy_distance, eye, 300, 0.02);
    }
}

TEST(Visibility, OfACoarseBallsContourIsWhole) {
    for (const int subdivisions : {1, 2, 3}) {
        const Scene scene(shapes::icosphere(subdivisions, 1));
        for (const Vec3& eye : {Vec3(6, 2, 4), Vec3(3, -6, 5), Vec3(1, 2, 8)}) {
            const Comparison found =
                compare(scene, LineType::contours, camera_at(eye), [](const Vec3d&) { return true; });
            EXPECT_GT(found.known, 100);
            EXPECT_LT(found.wrong, 0.001 * found.known) << subdivisions;
        }
    }
}

TEST(Visibility, OfAThinShellsContourIsThatOfItsOutside) {
    // The inner side is nearer to the outer one than the polygons are to a smooth ball.
    TriangleMesh inside = shapes::icosphere(3, 0.995f);
    for (Face& face : inside.faces) std::swap(face[1], face[2]);
    const Scene shell(shapes::joined(shapes::icosphere(3, 1), inside));
    const std::size_t outer = shapes::icosphere(3, 1).face_count();
    const Camera camera = camera_at({3, 2, 6});
    std::vector<LineSegment> contour = lines(shell, LineType::contours, camera);
    std::erase_if(contour, [&](const LineSegment& segment) { return segment.face >= outer; });
    const VisibleParts visible =
        LineVisibility(shell.surface()).visible_parts(LineType::contours, contour, camera, k_size, k_size);
    for (std::size_t s = 0; s < contour.size(); ++s) {
        ASSERT_EQ(visible.of(s).size(), 1) << s;
        EXPECT_EQ(visible.of(s)[0].from, 0);
        EXPECT_EQ(visible.of(s)[0].to, 1);
    }
}

TEST(Visibility, BehindABallEndsAtItsOutline) {
    // A ball of radius 1 at the origin, and one of radius 1.5 behind it and to its side.
    const Vec3 eye(0, 0, 10), behind(1.2f, 0.3f, -4);
    const Scene scene(shapes::joined(shapes::icosphere(5, 1), shapes::translated(shapes::icosphere(5, 1.5f), behind)));
    const Comparison found =
        compare(scene, LineType::contours, camera_at(eye), [&](const Vec3d& p) -> std::optional<bool> {
            if (p.norm() < 1.2) return true;
            // The distance of the ray from the front ball's center.
            const Vec3d far = eye.cast<double>(), way = (p - far).normalized();
            const double distance = (far - far.dot(way) * way).norm();
            if (std::abs(distance - 1) < 0.003) return std::nullopt;  // of polygons, within which a ball is not round
            return distance > 1;
        });
    EXPECT_GT(found.known - found.visible, 100);
    EXPECT_GT(found.visible, 500);
    EXPECT_EQ(found.wrong, 0);
}

TEST(Visibility, OfLinesThatAreOnTheSurfaceIsThatOfTheSurface) {
    const Scene scene(bumpy(5));
    for (const Vec3& eye : {Vec3(6, 2, 4), Vec3(-4, 5, -3)})
        for (const LineType type : {LineType::ridges, LineType::suggestive_contours, LineType::apparent_ridges}) {
            const Camera camera = camera_at(eye);
            const Comparison found = compare(scene, type, camera, [&](const Vec3d& p) {
                return sees(bumpy_distance, p, eye.cast<double>(), 0.05, 0.01);
            });
            EXPECT_GT(found.known, 60);
            EXPECT_LT(found.wrong, 0.02 * found.known) << name_of(type);
        }
}

TEST(Visibility, OfACubesEdgesIsExact) {
    for (const std::uint32_t n : {1u, 3u}) {
        const Scene scene(shapes::box(1, 1, 1, n));
        for (const Vec3& eye : {Vec3(3, 2, 4), Vec3(-5, 0.7f, 0.8f), Vec3(2, -9, 3)}) {
            // An edge is seen if one of its sides is; three edges of a cube seen from aside are not.
            const Comparison found = compare(scene, LineType::creases, camera_at(eye), [&](const Vec3d& p) {
                for (int axis = 0; axis < 3; ++axis)
                    if (std::abs(std::abs(p[axis]) - 0.5) < 1e-6 && p[axis] * double(eye[axis]) > 0.25) return true;
                return false;
            });
            EXPECT_EQ(found.wrong, 0);
            EXPECT_LT(found.visible, found.known - 100);
        }
    }
}

TEST(Visibility, ThroughAThinSheetIsNone) {
    // A slab a tenth as thick as its edges are long: the ridges of its far side are close behind the near one.
    const Scene scene(shapes::box(4, 4, 0.02f, 8));
    const auto seen = [&](const Vec3& eye, LineType type) {
        return compare(scene, type, camera_at(eye), [&](const Vec3d& p) -> std::optional<bool> {
            const bool rim = std::max(std::abs(p.x()), std::abs(p.y())) > 1.999;
            if (rim) return std::nullopt;
            return p.z() * double(eye.z()) > 0;
        });
    };
    EXPECT_EQ(seen({3, 2, 9}, LineType::creases).wrong, 0);
    // Marks in the middle of each face of both sides.
    const Camera camera = camera_at({1, 2, 9});
    std::vector<LineSegment> segments;
    for (std::uint32_t f = 0; f < scene.mesh.face_count(); ++f) {
        segments.emplace_back();
        segments.back().face = f;
        segments.back().ends = {{{0.4f, 0.3f, 0.3f}, {0.3f, 0.4f, 0.3f}}};
    }
    const auto parts =
        LineVisibility(scene.surface()).visible_parts(LineType::ridges, segments, camera, k_size, k_size);
    for (std::size_t s = 0; s < segments.size(); ++s) {
        const Vec3 p = scene.at(segments[s], 0.5f);
        if (std::max(std::abs(p.x()), std::abs(p.y())) < 1.99f) {
            EXPECT_EQ(parts.of(s).size(), p.z() > 0 ? 1u : 0u) << p.transpose();
        }
    }
}

TEST(Visibility, OfAnOpenSheetsBoundaryIsAllThatIsNotBehindIt) {
    // From in front, behind and aside, the rim of a plane sheet is seen.
    const Scene scene(shapes::translated(shapes::grid(6, 6, 2), {-1, -1, 0}));
    for (const Vec3& eye : {Vec3(1, 1, 8), Vec3(0, 1, -8), Vec3(8, 1, 0.1f)}) {
        const Comparison found =
            compare(scene, LineType::boundaries, camera_at(eye), [](const Vec3d&) { return true; });
        EXPECT_GT(found.known, 100);
        EXPECT_EQ(found.wrong, 0);
    }
}

TEST(Visibility, EndsBetweenThePointsOfASegmentWhereItChanges) {
    // One long segment behind a small square: two parts, with ends to a tenth of a pixel.
    TriangleMesh mesh = shapes::joined(shapes::translated(shapes::grid(1, 1, 8), {-4, -4, -2}),
                                       shapes::translated(shapes::grid(1, 1, 1), {-0.5f, -0.5f, 0}));
    const Scene scene(mesh);
    std::vector<LineSegment> segments(1);
    segments[0].face = 0;
    segments[0].ends = {{{0.9f, 0, 0.1f}, {0.1f, 0, 0.9f}}};  // along the diagonal of the square
    Camera camera;
    camera.view = look_at({0, 0, 10}, {0, 0, 0});
    camera.projection = orthographic(4, 1, 1, 20);
    const auto parts = LineVisibility(scene.surface()).visible_parts(LineType::ridges, segments, camera, 800, 800);
    ASSERT_EQ(parts.of(0).size(), 2);
    const auto pixel = [&](float t) { return camera.project(scene.at(segments[0], t), 800, 800).x(); };
    EXPECT_NEAR(pixel(parts.of(0)[0].to), 350, 0.1);
    EXPECT_NEAR(pixel(parts.of(0)[1].from), 450, 0.1);
    EXPECT_EQ(parts.of(0)[0].from, 0);
    EXPECT_EQ(parts.of(0)[1].to, 1);
}

/// A chain of segments of 10 pixels each, every other one reversed, with visible parts given along the chain.
struct Row {
    std::vector<Chain> chains = {Chain{}};
    VisibleParts visible;

    explicit Row(const std::vector<std::vector<VisiblePart>>& along) {
        for (std::uint32_t s = 0; s < along.size(); ++s) {
            const bool reversed = s % 2 == 1;
            chains[0].links.push_back({s, reversed});
            std::vector<VisiblePart> parts = along[s];
            if (reversed) {
                std::reverse(parts.begin(), parts.end());
                for (VisiblePart& part : parts) part = {1 - part.to, 1 - part.from};
            }
            visible.parts.insert(visible.parts.end(), parts.begin(), parts.end());
            visible.begin.push_back(static_cast<std::uint32_t>(visible.parts.size()));
            visible.pixels.push_back(10);
        }
    }
    /// What is visible of each segment, in pixels from its first end.
    std::vector<std::vector<int>> pixels() const {
        std::vector<std::vector<int>> result(visible.segment_count());
        for (std::size_t s = 0; s < result.size(); ++s)
            for (const VisiblePart& part : visible.of(s))
                for (const float end : {part.from, part.to}) result[s].push_back(int(std::lround(10 * end)));
        return result;
    }
};

TEST(Gaps, ThatAreShortAreClosed) {
    // Visible: 0 to 3, 5 to 9, 12 to 14, 19 to 20, 22 to 30 of 40 pixels.
    Row row({{{0, 0.3f}, {0.5f, 0.9f}}, {{0.2f, 0.4f}, {0.9f, 1}}, {{0.2f, 1}}, {}});
    Row same = row;
    close_gaps(row.chains, 3.5f, row.visible);
    using Pixels = std::vector<std::vector<int>>;
    EXPECT_EQ(row.pixels(), (Pixels{{0, 10}, {0, 1, 6, 10}, {0, 10}, {}}));  // the second one counts backward
    close_gaps(same.chains, 1, same.visible);
    EXPECT_EQ(same.pixels(), (Pixels{{0, 3, 5, 9}, {0, 1, 6, 8}, {2, 10}, {}}));
    close_gaps(same.chains, 100, same.visible);
    EXPECT_EQ(same.pixels(), (Pixels{{0, 10}, {0, 10}, {0, 10}, {}}));  // behind the last part there is no gap
    same.chains[0].closed = true;
    close_gaps(same.chains, 9, same.visible);
    EXPECT_EQ(same.pixels(), (Pixels{{0, 10}, {0, 10}, {0, 10}, {}}));
    close_gaps(same.chains, 11, same.visible);
    EXPECT_EQ(same.pixels(), (Pixels{{0, 10}, {0, 10}, {0, 10}, {0, 10}}));
}

TEST(Gaps, LeaveWholeSegmentsWhole) {
    Row row(std::vector<std::vector<VisiblePart>>(1000, {{0, 1}}));
    for (std::size_t i = 0; i < row.visible.pixels.size(); ++i)
        row.visible.pixels[i] = 3.7f + 0.001f * static_cast<float>(i);  // sums are rounded
    close_gaps(row.chains, 3, row.visible);
    ASSERT_EQ(row.visible.parts.size(), 1000);
    for (const VisiblePart& part : row.visible.parts) {
        EXPECT_EQ(part.from, 0);
        EXPECT_EQ(part.to, 1);
    }
}

TEST(Gaps, RefuseOtherChains) {
    Row row({{{0, 1}}, {{0, 1}}});
    row.chains[0].links.push_back({2, false});
    EXPECT_THROW(close_gaps(row.chains, 3, row.visible), UsageError);
    row.visible.pixels.pop_back();
    EXPECT_THROW(close_gaps(row.chains, 3, row.visible), UsageError);
}

TEST(Visibility, IsNoneOutsideThePicture) {
    const Scene scene(shapes::icosphere(3, 1));
    Camera camera = camera_at({0, 0, 5}, {100, 0, 5});  // looks past it
    const auto segments = lines(scene, LineType::contours, camera);
    ASSERT_FALSE(segments.empty());
    const auto beside = LineVisibility(scene.surface()).visible_parts(LineType::contours, segments, camera, 100, 100);
    EXPECT_TRUE(beside.parts.empty());
    camera = camera_at({0, 0, 5});
    camera.projection = perspective(0.5f, 1, 6, 10);  // nearer than the near plane
    EXPECT_TRUE(
        LineVisibility(scene.surface()).visible_parts(LineType::contours, segments, camera, 100, 100).parts.empty());
}

TEST(Visibility, DoesNotDependOnThreads) {
    const Scene scene(bumpy(4));
    const Camera camera = camera_at({6, 2, 4});
    const auto segments = lines(scene, LineType::contours, camera);
    const LineVisibility visibility(scene.surface());
    const auto many = visibility.visible_parts(LineType::contours, segments, camera, k_size, k_size);
    const ThreadLimit limit(1);
    const auto one = visibility.visible_parts(LineType::contours, segments, camera, k_size, k_size);
    EXPECT_EQ(one.begin, many.begin);
    for (std::size_t i = 0; i < one.parts.size(); ++i) EXPECT_EQ(one.parts[i].to, many.parts[i].to);
}

TEST(Visibility, RefusesWhatDoesNotFit) {
    Scene scene(shapes::icosphere(1, 1));
    const LineVisibility visibility(scene.surface());
    std::vector<LineSegment> segments(1);
    const Camera camera = camera_at({6, 2, 4});
    EXPECT_THROW(visibility.visible_parts(LineType::ridges, segments, camera, 0, 10), UsageError);
    EXPECT_THROW(visibility.visible_parts(LineType::ridges, segments, camera, 10, 10, {.spacing = 0}), UsageError);
    segments[0].face = 1000;
    EXPECT_THROW(visibility.visible_parts(LineType::ridges, segments, camera, 10, 10), UsageError);
    scene.normals.pop_back();
    EXPECT_THROW(LineVisibility{scene.surface()}, UsageError);
}

}  // namespace
}  // namespace exemplar
