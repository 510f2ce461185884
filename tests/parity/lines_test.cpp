#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "gpu/lines/chains.h"
#include "gpu/lines/extraction.h"
#include "gpu/lines/line_renderer.h"
#include "host/core/errors.h"
#include "host/lines/chains.h"
#include "host/lines/strokes.h"
#include "host/lines/visibility.h"
#include "host/mesh/curvature_estimator.h"
#include "shaders/shared/lines.h"
#include "tests/gpu/support/environment.h"
#include "tests/parity/surfaces.h"

// Fields agree to some roundings of single precision, so that a face may carry a line on one side only where the line
// just touches it, or where its strength is the threshold: that is allowed of one segment in two hundred. What both
// have is off by what such roundings do to zeros, more where two almost equal values are taken apart.
namespace exemplar {
namespace {

using shared::LineCounts;
using shared::LinePoint;
using shared::LineSegmentRecord;
using shared::vec4;
using testing::shared_device;

constexpr int k_width = 800, k_height = 600;

/// A surface with estimated curvature, on both sides.
struct Scene {
    TriangleMesh mesh;
    std::vector<Vec3> normals;
    VertexCurvature curvature;
    std::vector<FaceNeighbors> neighbors;
    GpuSurface surface;
    GpuLineSurface line_surface;
    Buffer vertices, device_normals, first, second, derivative;

    explicit Scene(TriangleMesh given)
        : mesh(std::move(given)),
          neighbors(build_face_neighbors(mesh.faces, mesh.vertex_count())),
          surface(shared_device(), mesh),
          line_surface(surface),
          vertices(testing::upload_vertices(shared_device(), mesh.vertices)) {
        CurvatureEstimator estimator(mesh.faces, mesh.vertex_count());
        curvature = estimator.estimate(mesh.vertices, {.derivatives = true, .smoothing = 1});
        normals = estimator.normals();
        device_normals = upload(normals, std::vector<float>(mesh.vertex_count(), 0));
        first = upload(curvature.e1, curvature.k1);
        second = upload(curvature.e2, curvature.k2);
        std::vector<vec4> derivatives;
        for (const auto& [a, b, c, d] : curvature.derivative) derivatives.push_back({a, b, c, d});
        derivative = Buffer::of<vec4>(shared_device(), derivatives);
    }
    static Buffer upload(const std::vector<Vec3>& vectors, const std::vector<float>& last) {
        std::vector<vec4> out;
        for (std::size_t i = 0; i < vectors.size(); ++i)
            out.push_back({vectors[i].x(), vectors[i].y(), vectors[i].z(), last[i]});
        return Buffer::of<vec4>(shared_device(), out);
    }
    GpuCurvedSurface moment() const { return {vertices, device_normals, &first, &second, &derivative}; }
    LineSurface on_host() const { return {mesh.faces, mesh.vertices, normals, curvature, neighbors}; }
    float size() const { return feature_size(mesh.vertices, curvature); }
};

TriangleMesh lumpy() {
    return shapes::transformed(shapes::icosphere(5, 1), [](const Vec3& p) -> Vec3 {
        return p * (1 + 0.2f * std::sin(3 * p.x() + 1) + 0.15f * p.y() * std::cos(4 * p.z()));
    });
}

/// Hollows, boundaries and creases.
TriangleMesh mixed() {
    const TriangleMesh round =
        shapes::joined(testing::waved(shapes::torus(3, 1, 61, 23), 0.2f), shapes::translated(lumpy(), Vec3(0, 0, 3)));
    return shapes::joined(round,
                          shapes::joined(shapes::translated(shapes::box(2, 2, 2, 3), Vec3(4, 1, 3)),
                                         shapes::translated(shapes::cylinder(1, 2, 20, 5, false), Vec3(4, 5, 1))));
}

GpuLineOptions on_device(const LineOptions& options) {
    return {.eye = {options.eye.x(), options.eye.y(), options.eye.z(), options.parallel_eye ? 0.0f : 1.0f},
            .feature_size = options.feature_size,
            .thresholds = family_thresholds(options.thresholds)};
}

struct Found {
    LineCounts counts;
    std::vector<LineSegmentRecord> segments;
};

Found extract_on_device(const Scene& scene, GpuLineExtraction& lines, std::uint32_t families,
                        const LineOptions& options) {
    Stream stream(shared_device());
    lines.record(stream, scene.moment(), families, on_device(options));
    stream.finish();
    Found found{};
    lines.counts().download(std::span(&found.counts, 1));
    found.segments.resize(found.counts.segments);
    lines.segments().download(std::span(found.segments));
    return found;
}

std::uint32_t family_of(const LineSegmentRecord& segment) {
    return segment.kind & shared::k_kind_family;
}
std::uint32_t family_of(LineType type, const LineSegment& segment) {
    const LineType types[] = {type};
    const std::uint32_t families = line_families(types);
    return static_cast<std::uint32_t>(std::countr_zero(families)) + segment.family;
}

/// What tells one segment of a face and family from another: where it ends.
using SegmentKey = std::array<std::uint32_t, 4>;

std::map<SegmentKey, LineSegmentRecord> by_key(const std::vector<LineSegmentRecord>& segments) {
    std::map<SegmentKey, LineSegmentRecord> result;
    for (const LineSegmentRecord& s : segments)
        result[{s.face, family_of(s), s.kind >> shared::k_kind_first_place & shared::k_kind_place,
                s.kind >> shared::k_kind_second_place & shared::k_kind_place}] = s;
    return result;
}

LineSegmentRecord record_of(LineType type, const LineSegment& s) {
    return {.face = s.face,
            .kind = family_of(type, s) | std::uint32_t{s.places[0]} << shared::k_kind_first_place |
                    std::uint32_t{s.places[1]} << shared::k_kind_second_place,
            .first_strength = s.strength[0],
            .second_strength = s.strength[1],
            .ends = {s.ends[0][1], s.ends[0][2], s.ends[1][1], s.ends[1][2]}};
}

float end_difference(const LineSegmentRecord& a, const LineSegmentRecord& b) {
    return std::max({std::abs(a.ends.x - b.ends.x), std::abs(a.ends.y - b.ends.y), std::abs(a.ends.z - b.ends.z),
                     std::abs(a.ends.w - b.ends.w)});
}

void expect_same_lines(const Scene& scene, const std::vector<LineType>& types, const LineOptions& options) {
    std::vector<LineSegmentRecord> expected;
    for (const LineType type : types)
        for (const LineSegment& segment : extract_lines(scene.on_host(), type, options))
            expected.push_back(record_of(type, segment));
    GpuLineExtraction lines(scene.line_surface);
    const Found found = extract_on_device(scene, lines, line_families(types), options);
    EXPECT_EQ(found.counts.dropped_segments, 0u);
    for (std::size_t i = 1; i < found.segments.size(); ++i)
        ASSERT_LE(std::make_pair(found.segments[i - 1].face, family_of(found.segments[i - 1])),
                  std::make_pair(found.segments[i].face, family_of(found.segments[i])));

    const auto wanted = by_key(expected), got = by_key(found.segments);
    std::size_t missing = 0, off = 0;
    for (const auto& [key, segment] : wanted) {
        const auto same = got.find(key);
        if (same == got.end()) {
            ++missing;
            continue;
        }
        const float scale = std::max(1.0f, std::abs(segment.first_strength));
        if (end_difference(segment, same->second) > 2e-3f ||
            std::abs(segment.first_strength - same->second.first_strength) > 2e-3f * scale)
            ++off;
    }
    const std::size_t allowed = wanted.size() / 200;
    EXPECT_LE(missing, allowed);
    EXPECT_LE(off, allowed);
    EXPECT_LE(got.size(), wanted.size() + allowed);
}

class LineParity : public ::testing::TestWithParam<LineType> {};

TEST_P(LineParity, SegmentsAreThoseOfTheReference) {
    for (const TriangleMesh& mesh : {lumpy(), mixed()}) {
        const Scene scene(mesh);
        for (const bool parallel : {false, true}) {
            LineOptions options{
                .eye = parallel ? Vec3(Vec3(3.07f, 2.11f, 4.23f).normalized()) : Vec3(6.13f, 4.29f, 8.41f),
                .parallel_eye = parallel,
                .feature_size = scene.size(),
                .thresholds = {}};
            expect_same_lines(scene, {GetParam()}, options);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(AllTypes, LineParity, ::testing::ValuesIn(k_line_types),
                         [](const auto& type) { return std::string(name_of(type.param)); });

TEST(LineParityOfAll, TypesAtOnceAreThoseOneByOne) {
    const Scene scene(mixed());
    expect_same_lines(scene, {k_line_types.begin(), k_line_types.end()},
                      {.eye = {6.13f, 4.29f, 8.41f}, .feature_size = scene.size(), .thresholds = {}});
}

TEST(LineParityOfAll, OddSizesAndNoFaces) {
    for (const std::size_t vertices : {3u, 4u, 65u, 66u, 67u}) {
        const Scene scene(testing::strip(vertices));
        expect_same_lines(scene, {k_line_types.begin(), k_line_types.end()},
                          {.eye = {6.13f, 4.29f, 8.41f}, .feature_size = 0.1f, .thresholds = {}});
    }
    TriangleMesh none;
    none.vertices = {Vec3::Zero(), Vec3::UnitX()};
    const Scene scene(none);
    GpuLineExtraction lines(scene.line_surface);
    EXPECT_EQ(extract_on_device(scene, lines, shared::k_field_families, {.feature_size = 1, .thresholds = {}})
                  .counts.segments,
              0u);
}

TEST(LineParityOfAll, WhatThereIsNoRoomForIsCountedAndLeftOut) {
    const Scene scene(lumpy());
    GpuLineExtraction small(scene.line_surface, 100), enough(scene.line_surface);
    const LineOptions options{.eye = {6.13f, 4.29f, 8.41f}, .feature_size = scene.size(), .thresholds = {}};
    const Found some = extract_on_device(scene, small, 1, options), all = extract_on_device(scene, enough, 1, options);
    ASSERT_GT(all.counts.segments, 100u);
    EXPECT_EQ(some.counts.segments, 100u);
    EXPECT_EQ(some.counts.dropped_segments, all.counts.segments - 100);
    for (std::size_t i = 0; i < 100; ++i) ASSERT_EQ(some.segments[i].face, all.segments[i].face);
}

TEST(LineParityOfAll, OtherTypesBetweenChangeNothing) {
    const Scene scene(mixed());
    GpuLineExtraction lines(scene.line_surface);
    const LineOptions options{.eye = {6.13f, 4.29f, 8.41f}, .feature_size = scene.size(), .thresholds = {}};
    const std::uint32_t some = 1u << shared::k_ridges | 1u << shared::k_creases,
                        apparent = 1u << shared::k_apparent_ridges;
    const Found before = extract_on_device(scene, lines, some, options);
    ASSERT_GT(before.counts.segments, 100u);
    for (const std::uint32_t other : {0x3ffu, 1u << shared::k_contours, apparent, 0u, apparent}) {
        const Found between = extract_on_device(scene, lines, other, options);
        EXPECT_EQ(between.counts.segments > 0, other != 0);
        const Found after = extract_on_device(scene, lines, some, options);
        ASSERT_EQ(after.counts.segments, before.counts.segments);
        EXPECT_EQ(0, std::memcmp(after.segments.data(), before.segments.data(),
                                 before.segments.size() * sizeof(LineSegmentRecord)));
    }
}

TEST(LineParityOfAll, CurvatureIsAskedForWhereItIsNeeded) {
    const Scene scene(lumpy());
    GpuLineExtraction lines(scene.line_surface);
    Stream stream(shared_device());
    const GpuCurvedSurface flat{scene.vertices, scene.device_normals};
    EXPECT_THROW(lines.record(stream, flat, 2, on_device({.feature_size = 1, .thresholds = {}})), UsageError);
    EXPECT_THROW(lines.record(stream, scene.moment(), 2, on_device({.feature_size = 0, .thresholds = {}})), UsageError);
    EXPECT_NO_THROW(lines.record(stream, flat, 1, on_device({.eye = {6.13f, 4.29f, 8.41f}, .thresholds = {}})));
}

/// A chain as the numbers of its segments, with what is walked from the second end.
using Walk = std::vector<std::pair<std::uint32_t, bool>>;

struct FoundChains {
    Found found;
    std::vector<LinePoint> points;
    std::vector<Walk> walks;  // by first segment
    std::vector<bool> closed;
};

FoundChains chain_on_device(const Scene& scene, std::uint32_t families, const LineOptions& options,
                            const Camera& camera) {
    GpuLineExtraction lines(scene.line_surface);
    GpuChains chains(lines);
    Stream stream(shared_device());
    lines.record(stream, scene.moment(), families, on_device(options));
    chains.record(stream, scene.vertices, camera, k_width, k_height);
    stream.finish();
    FoundChains result{};
    lines.counts().download(std::span(&result.found.counts, 1));
    result.found.segments.resize(result.found.counts.segments);
    lines.segments().download(std::span(result.found.segments));
    result.points.resize(result.found.counts.points);
    chains.points().download(std::span(result.points));
    for (const LinePoint& point : result.points) {
        if (point.kind & shared::k_point_first) {
            result.walks.emplace_back();
            result.closed.push_back(point.kind & shared::k_point_closed);
        }
        if (!(point.kind & shared::k_point_last))
            result.walks.back().emplace_back(point.segment / 2, point.segment % 2);
    }
    return result;
}

/// The device's own segments of one type, for the reference to chain, and their numbers on the device.
struct Own {
    std::vector<LineSegment> segments;
    std::vector<std::uint32_t> numbers;
};
Own own_segments(const Found& found, LineType type) {
    Own own;
    for (std::uint32_t i = 0; i < found.segments.size(); ++i) {
        const LineSegmentRecord& s = found.segments[i];
        if (type_of_family(family_of(s)) != type) continue;
        LineSegment segment;
        segment.face = s.face;
        segment.family = family_of(s) == shared::k_second_highlights ? 1 : 0;
        segment.places = {static_cast<SegmentEnd>(s.kind >> shared::k_kind_first_place & shared::k_kind_place),
                          static_cast<SegmentEnd>(s.kind >> shared::k_kind_second_place & shared::k_kind_place)};
        own.segments.push_back(segment);
        own.numbers.push_back(i);
    }
    return own;
}

/// How many chains both have.
std::size_t expect_same_chains(const Scene& scene, const std::vector<LineType>& types) {
    const Camera camera = fit_camera(scene.mesh, Vec3(3.07f, 2.11f, 4.23f), float(k_width) / k_height);
    const FoundChains found =
        chain_on_device(scene, line_families(types),
                        {.eye = camera.position(), .feature_size = scene.size(), .thresholds = {}}, camera);
    std::set<std::pair<bool, Walk>> expected, actual;
    for (const LineType type : types) {
        const Own own = own_segments(found.found, type);
        for (const Chain& chain : chain_segments(scene.mesh.faces, scene.neighbors, own.segments)) {
            Walk walk;
            for (const ChainLink& link : chain.links) walk.emplace_back(own.numbers[link.segment], link.reversed);
            expected.emplace(chain.closed, walk);
        }
    }
    std::size_t walked = 0;
    for (std::size_t i = 0; i < found.walks.size(); ++i) {
        actual.emplace(found.closed[i], found.walks[i]);
        walked += found.walks[i].size();
    }
    EXPECT_EQ(walked, found.found.segments.size());
    EXPECT_EQ(actual, expected);
    return expected.size();
}

TEST(ChainParity, ChainsAreThoseOfTheReference) {
    const Scene scene(mixed()), smooth(lumpy());
    std::size_t one_by_one = 0;
    for (const LineType type : k_line_types) one_by_one += expect_same_chains(scene, {type});
    EXPECT_EQ(expect_same_chains(scene, {k_line_types.begin(), k_line_types.end()}), one_by_one);
    EXPECT_GT(expect_same_chains(smooth, {k_line_types.begin(), k_line_types.end() - 2}), 20u);
}

TEST(ChainParity, PointsAreWhereTheCameraSeesThem) {
    const Scene scene(mixed());
    const Camera camera = fit_camera(scene.mesh, Vec3(3.07f, 2.11f, 4.23f), float(k_width) / k_height);
    const FoundChains found =
        chain_on_device(scene, 3, {.eye = camera.position(), .feature_size = scene.size(), .thresholds = {}}, camera);
    float along = 0;
    for (std::size_t i = 0; i < found.points.size(); ++i) {
        const LinePoint& point = found.points[i];
        const LineSegmentRecord& s = found.found.segments[point.segment / 2];
        const bool second = (point.segment % 2 != 0) != ((point.kind & shared::k_point_last) != 0);
        const float b = second ? s.ends.z : s.ends.x, c = second ? s.ends.w : s.ends.y;
        const Face& face = scene.mesh.faces[s.face];
        const Vec3 at = (1 - b - c) * scene.mesh.vertices[face[0]] + b * scene.mesh.vertices[face[1]] +
                        c * scene.mesh.vertices[face[2]];
        const Vec3 seen = camera.project(at, k_width, k_height);
        ASSERT_NEAR(point.x, seen.x(), 2e-3f);
        ASSERT_NEAR(point.y, seen.y(), 2e-3f);
        ASSERT_NEAR(point.depth, seen.z(), 1e-5f);
        if (point.kind & shared::k_point_first)
            along = 0;
        else
            along += std::hypot(point.x - found.points[i - 1].x, point.y - found.points[i - 1].y);
        ASSERT_NEAR(point.parameter, along, 1e-3f + 1e-4f * along);
        if (point.kind & shared::k_point_closed && point.kind & shared::k_point_last) {
            const auto first =
                std::find_if(found.points.rend() - static_cast<std::ptrdiff_t>(i) - 1, found.points.rend(),
                             [](const LinePoint& p) { return p.kind & shared::k_point_first; });
            EXPECT_NEAR(first->x, point.x, 1e-2f);
            EXPECT_NEAR(first->y, point.y, 1e-2f);
        }
    }
    EXPECT_GT(found.points.size(), 100u);
}

TEST(ChainParity, RerunsAreTheSameBytes) {
    const Scene scene(mixed());
    const Camera camera = fit_camera(scene.mesh, Vec3(3.07f, 2.11f, 4.23f), float(k_width) / k_height);
    const LineOptions options{.eye = camera.position(), .feature_size = scene.size(), .thresholds = {}};
    const FoundChains once = chain_on_device(scene, 0x3ff, options, camera);
    for (int i = 0; i < 5; ++i) {
        const FoundChains again = chain_on_device(scene, 0x3ff, options, camera);
        ASSERT_EQ(once.points.size(), again.points.size());
        EXPECT_EQ(0, std::memcmp(once.points.data(), again.points.data(), once.points.size() * sizeof(LinePoint)));
    }
}

/// A drawing of one type on the device, without tapers, and the same on the host from the device's own segments.
struct DrawnLines {
    std::vector<LinePoint> points;
    std::vector<vec4> strokes;                          // two a point
    std::vector<std::array<std::uint32_t, 2>> visible;  // of each point
    std::vector<LineSegment> segments;                  // of the device, as the host has them
    std::vector<Stroke> expected;                       // of all, none hidden
    VisibleParts parts;                                 // by rays
    StrokeView view;
};

DrawnLines draw(const Scene& scene, LineType type, bool parallel) {
    DrawnLines drawn;
    const FitOptions fit{.vertical_fov = parallel ? 0.0f : 0.4f};
    drawn.view = {.camera = fit_camera(scene.mesh, Vec3(3.07f, 2.11f, 4.23f), float(k_width) / k_height, fit),
                  .width = k_width,
                  .height = k_height,
                  .unit_depth = 20,
                  .feature_size = scene.size()};
    const LineType types[] = {type};
    const StrokeThickness thickness{.taper = 0};
    LinePicture picture;
    picture.view = drawn.view;
    picture.families = line_families(types);
    LineThresholds thresholds;
    thresholds.principal_highlights = 0.001f;  // so that there are some
    picture.thresholds = family_thresholds(thresholds);
    picture.looks = plain_looks(thresholds, thickness);
    LineRenderer renderer(shared_device(), scene.line_surface);
    Stream stream(shared_device());
    renderer.render(stream, scene.moment(), picture);

    LineCounts counts{};
    const GpuLineExtraction& lines = renderer.strokes().chains().lines();
    lines.counts().download(std::span(&counts, 1));
    std::vector<LineSegmentRecord> records(counts.segments);
    lines.segments().download(std::span(records));
    drawn.points.resize(counts.points);
    renderer.strokes().chains().points().download(std::span(drawn.points));
    drawn.strokes.resize(2 * counts.points);
    renderer.strokes().strokes().download(std::span(drawn.strokes));
    drawn.visible.resize(counts.points);
    renderer.strokes().visible().download(std::span(drawn.visible));

    drawn.segments = own_segments({counts, records}, type).segments;
    for (std::size_t i = 0; i < records.size(); ++i) {
        const LineSegmentRecord& r = records[i];
        drawn.segments[i].ends = {
            {{1 - r.ends.x - r.ends.y, r.ends.x, r.ends.y}, {1 - r.ends.z - r.ends.w, r.ends.z, r.ends.w}}};
        drawn.segments[i].strength = {r.first_strength, r.second_strength};
    }
    const std::vector<Chain> chains = chain_segments(scene.mesh.faces, scene.neighbors, drawn.segments);
    // The device orders chains by the segment they start with.
    std::map<std::uint32_t, Stroke> by_start;
    std::vector<Stroke> strokes =
        make_strokes(scene.on_host(), type, drawn.segments, chains, nullptr, drawn.view, thresholds, thickness);
    for (std::size_t i = 0; i < chains.size(); ++i) by_start[chains[i].links[0].segment] = std::move(strokes[i]);
    for (auto& [start, stroke] : by_start) drawn.expected.push_back(std::move(stroke));
    drawn.parts =
        LineVisibility(scene.on_host()).visible_parts(type, drawn.segments, drawn.view.camera, k_width, k_height);
    return drawn;
}

class StrokeParity : public ::testing::TestWithParam<LineType> {};

TEST_P(StrokeParity, PointsAreDrawnWhereTheReferenceDrawsThem) {
    const Scene scene(mixed());
    for (const bool parallel : {false, true}) {
        const DrawnLines drawn = draw(scene, GetParam(), parallel);
        std::size_t at = 0;
        for (const Stroke& stroke : drawn.expected)
            for (const StrokePoint& point : stroke.points) {
                ASSERT_LT(at, drawn.points.size());
                const vec4 &place = drawn.strokes[2 * at], &normal = drawn.strokes[2 * at + 1];
                ++at;
                ASSERT_NEAR(place.x, point.position.x(), 5e-3f);
                ASSERT_NEAR(place.y, point.position.y(), 5e-3f);
                ASSERT_NEAR(place.z, point.width, 1e-3f * point.width + 1e-4f);
                ASSERT_NEAR(place.w, point.opacity, 1e-3f);
                ASSERT_GT(normal.x * point.normal.x() + normal.y * point.normal.y(), 0.99f);
            }
        EXPECT_EQ(at, drawn.points.size());
    }
}

bool seen_by_rays(const DrawnLines& drawn, const LinePoint& from, float t) {
    const std::span<const VisiblePart> parts = drawn.parts.of(from.segment / 2);
    if (from.segment % 2) t = 1 - t;
    return std::any_of(parts.begin(), parts.end(),
                       [&](const VisiblePart& part) { return part.from <= t && t <= part.to; });
}

/// Whether something is in front of a point of the picture and of all that is 2.5 pixels from it: pixels show what rays
/// hide where less is.
bool is_well_covered(const RayScene& rays, const StrokeView& view, const Vec3& at) {
    constexpr float k_apart = 2.5f;
    const Eigen::Matrix4f to_world = view.camera.view_projection().inverse();
    const auto world = [&](float x, float y, float depth) -> Vec3 {
        const Eigen::Vector4f clip(2 * x / k_width - 1, 2 * y / k_height - 1, depth, 1);
        return (to_world * clip).hnormalized();
    };
    for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) {
            const float x = at.x() + k_apart * static_cast<float>(dx), y = at.y() + k_apart * static_cast<float>(dy);
            const Vec3 eye = view.camera.position(), there = world(x, y, at.z());
            const auto hit = rays.first_hit(eye, (there - eye).normalized(), 0);
            if (!hit || hit->distance > (there - eye).norm() - 0.005f * view.unit_depth) return false;
        }
    return true;
}

TEST_P(StrokeParity, WhatIsHiddenIsHiddenByRays) {
    for (const TriangleMesh& mesh : {mixed(), lumpy()}) {
        const Scene scene(mesh);
        const RayScene rays(mesh);
        const DrawnLines drawn = draw(scene, GetParam(), false);
        float length = 0, wrongly_hidden = 0, wrongly_shown = 0, shown = 0;
        for (std::size_t i = 0; i + 1 < drawn.points.size(); ++i) {
            const LinePoint &point = drawn.points[i], &next = drawn.points[i + 1];
            if (point.kind & shared::k_point_last) continue;
            const auto [mask, samples] = drawn.visible[i];
            const float share = std::hypot(next.x - point.x, next.y - point.y) / static_cast<float>(samples);
            for (std::uint32_t k = 0; k < samples; ++k) {
                const float t = (static_cast<float>(k) + 0.5f) / static_cast<float>(samples);
                const bool expected = seen_by_rays(drawn, point, t), actual = (mask >> k & 1u) != 0;
                length += share;
                if (expected && !actual) wrongly_hidden += share;
                if (expected || !actual) continue;
                shown += share;
                const Vec3 at(point.x + t * (next.x - point.x), point.y + t * (next.y - point.y),
                              point.depth + t * (next.depth - point.depth));
                if (is_well_covered(rays, drawn.view, at)) wrongly_shown += share;
            }
        }
        EXPECT_LE(wrongly_hidden, 0.002f * length);
        EXPECT_LE(wrongly_shown, 0.002f * length);
    }
}

INSTANTIATE_TEST_SUITE_P(AllTypes, StrokeParity, ::testing::ValuesIn(k_line_types),
                         [](const auto& type) { return std::string(name_of(type.param)); });

}  // namespace
}  // namespace exemplar
