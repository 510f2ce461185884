#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "gpu/lines/device_style.h"
#include "gpu/lines/line_renderer.h"
#include "host/lines/strokes/stroke_raster.h"
#include "host/lines/strokes/stroke_textures.h"
#include "host/lines/strokes/strokes.h"
#include "host/lines/strokes/visibility.h"
#include "tests/parity/line_scene.h"

namespace exemplar {
namespace {

using namespace test_support;

LineStyle even_style() {
    LineStyle style;
    style.thickness.taper = 0;
    return style;
}

/// A drawing of one type on the device, and the same on the host from the device's own segments.
struct DrawnLines {
    std::vector<LinePoint> points;
    std::vector<vec4> strokes;                          // two a point
    std::vector<std::array<std::uint32_t, 2>> visible;  // of each point
    std::vector<LineSegment> segments;                  // of the device, as the host has them
    std::vector<Stroke> expected;                       // of all, none hidden
    VisibleParts parts;                                 // by rays
    StrokeView view;
    Image image;
};

DrawnLines draw(const Scene& scene, LineType type, bool parallel, const LineStyle& line = even_style(),
                const PartInks& inks = {}) {
    DrawnLines drawn;
    const FitOptions fit{.vertical_fov = parallel ? 0.0f : 0.4f};
    drawn.view = {.camera = fit_camera(scene.mesh, Vec3(3.07f, 2.11f, 4.23f), picture_aspect(), fit),
                  .width = picture_width(),
                  .height = picture_height(),
                  .unit_depth = 20,
                  .feature_size = scene.size()};
    const LineType types[] = {type};
    LinePicture picture;
    picture.view = drawn.view;
    picture.families = line_families(types);
    LineThresholds thresholds;
    thresholds.principal_highlights = 0.001f;  // so that there are some
    picture.thresholds = family_thresholds(thresholds);
    DrawingStyle style;
    style.of(type) = line;
    if (type == LineType::principal_highlights) style.of(type).threshold = thresholds.principal_highlights;
    const DeviceStyle looks = device_style(style);
    picture.looks = looks.looks;
    LineRenderer renderer(shared_device(), scene.line_surface);
    renderer.set_textures(looks.textures);
    renderer.set_part_inks(inks);
    Stream stream(shared_device());
    drawn.image = renderer.render(stream, scene.snapshot(), picture);

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

    drawn.segments = segments_of_type(records, type).segments;
    const std::vector<Chain> chains =
        chain_segments(scene.joined, scene.neighbors, drawn.segments, type != LineType::contours);
    // The device orders chains by the segment they start with.
    std::map<std::uint32_t, Stroke> by_start;
    std::vector<Stroke> strokes =
        make_strokes(scene.surface(), type, drawn.segments, chains, nullptr, drawn.view, thresholds, line.thickness);
    for (std::size_t i = 0; i < chains.size(); ++i) by_start[chains[i].links[0].segment] = std::move(strokes[i]);
    for (auto& [start, stroke] : by_start) drawn.expected.push_back(std::move(stroke));
    drawn.parts = LineVisibility(scene.surface())
                      .visible_parts(type, drawn.segments, drawn.view.camera, picture_width(), picture_height());
    return drawn;
}

constexpr float k_place_tolerance = 5e-3f;  // pixels

/// The smallest cosine between normals that two computations may have at a point of a stroke: a normal is across the
/// line from the point before to the one after, and turns by what their places differ over the length of that line.
float min_cosine(const Stroke& stroke, std::size_t at) {
    const auto& before = stroke.points[at == 0 ? 0 : at - 1];
    const auto& after = stroke.points[std::min(at + 1, stroke.points.size() - 1)];
    const float turn = 2 * k_place_tolerance / std::max((after.position - before.position).norm(), 1e-6f);
    return std::min(0.99f, 1 - 0.5f * turn * turn);
}

void expect_strokes_of_the_reference(const DrawnLines& drawn) {
    std::size_t at = 0;
    for (const Stroke& stroke : drawn.expected)
        for (std::size_t i = 0; i < stroke.points.size(); ++i) {
            const StrokePoint& point = stroke.points[i];
            ASSERT_LT(at, drawn.points.size());
            const vec4 &place = drawn.strokes[2 * at], &normal = drawn.strokes[2 * at + 1];
            ++at;
            ASSERT_NEAR(place.x, point.position.x(), k_place_tolerance);
            ASSERT_NEAR(place.y, point.position.y(), k_place_tolerance);
            ASSERT_NEAR(place.z, point.width, 1e-3f * point.width + 1e-4f);
            ASSERT_NEAR(place.w, point.opacity, 1e-3f);
            ASSERT_GT(normal.x * point.normal.x() + normal.y * point.normal.y(), min_cosine(stroke, i));
        }
    EXPECT_EQ(at, drawn.points.size());
}

class StrokeParity : public ::testing::TestWithParam<LineType> {};

TEST_P(StrokeParity, PointsAreDrawnWhereTheReferenceDrawsThem) {
    const Scene scene(mixed());
    for (const bool parallel : {false, true}) expect_strokes_of_the_reference(draw(scene, GetParam(), parallel));
}

TEST(StrokesOfACan, AreThoseOfTheReference) {
    const Scene can(shapes::cylinder(1, 2, 24, 3, true), true);
    for (const bool parallel : {false, true}) expect_strokes_of_the_reference(draw(can, LineType::contours, parallel));
}

// Contours of its side, whose ends are on its rims.
TEST(StrokesOfACan, KeepTheirWidthWhereTheyMeetItsRims) {
    const Scene can(shapes::cylinder(1, 2, 24, 3, true), true);
    LineStyle tapered;
    tapered.thickness.taper = 40;
    const DrawnLines drawn = draw(can, LineType::contours, false, tapered);
    std::size_t ends = 0;
    float narrowest = std::numeric_limits<float>::max();
    for (std::size_t i = 0; i < drawn.points.size(); ++i) {
        if ((drawn.points[i].kind & shared::k_kind_family) != shared::k_contours) continue;
        ends += (drawn.points[i].kind & (shared::k_point_first | shared::k_point_last)) != 0;
        narrowest = std::min(narrowest, drawn.strokes[2 * i].z);
    }
    EXPECT_EQ(ends, 4);
    EXPECT_GT(narrowest, 1);
}

TEST(StrokesOfParts, HaveTheirInkAndItsWidth) {
    const Scene scene(lumpy());
    PartInks inks{{PartInk{}, {Color{255, 0, 0}, 2.5F}}, {"", "part"}, {}};
    for (const Face& face : scene.mesh.faces) inks.ink_of_face.push_back(scene.mesh.vertices[face[0]].x() > 0 ? 1 : 0);
    const DrawnLines plain = draw(scene, LineType::contours, false);
    const DrawnLines inked = draw(scene, LineType::contours, false, even_style(), inks);
    ASSERT_EQ(inked.points.size(), plain.points.size());
    std::array<std::size_t, 2> points{};
    for (std::size_t i = 0; i < inked.points.size(); ++i) {
        const std::uint32_t ink = inks.ink_of_face[inked.segments.at(inked.points[i].segment / 2).face];
        ++points[ink];
        ASSERT_EQ(inked.strokes[2 * i + 1].z, static_cast<float>(ink));
        ASSERT_FLOAT_EQ(inked.strokes[2 * i].z, (ink ? 2.5F : 1.0F) * plain.strokes[2 * i].z);
    }
    EXPECT_GT(points[0], 50U);
    EXPECT_GT(points[1], 50U);
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
        const Eigen::Vector4f clip(2 * x / static_cast<float>(picture_width()) - 1,
                                   2 * y / static_cast<float>(picture_height()) - 1, depth, 1);
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

/// The strokes that the device has drawn, as the host would draw them: ways to the next point in pieces, a sample each.
std::vector<Stroke> drawn_strokes(const DrawnLines& drawn) {
    std::vector<Stroke> result;
    const auto point = [&](std::size_t i) {
        const vec4 &place = drawn.strokes[2 * i], &normal = drawn.strokes[2 * i + 1];
        StrokePoint at;
        at.position = {place.x, place.y};
        at.normal = {normal.x, normal.y};
        at.width = place.z;
        at.opacity = place.w;
        at.parameter = drawn.points[i].parameter;
        return at;
    };
    for (std::size_t i = 0; i < drawn.points.size(); ++i) {
        if (drawn.points[i].kind & shared::k_point_first) result.emplace_back();
        if (drawn.points[i].kind & shared::k_point_last) {
            result.back().points.push_back(point(i));
            continue;
        }
        const StrokePoint from = point(i), to = point(i + 1);
        const auto [mask, samples] = drawn.visible[i];
        for (std::uint32_t k = 0; k < samples; ++k) {
            const float t = static_cast<float>(k) / static_cast<float>(samples);
            StrokePoint at = from;
            at.position += t * (to.position - from.position);
            at.width = std::lerp(from.width, to.width, t);
            at.opacity = std::lerp(from.opacity, to.opacity, t);
            at.parameter = std::lerp(from.parameter, to.parameter, t);
            at.visible = (mask >> k & 1u) != 0;
            result.back().points.push_back(at);
        }
    }
    return result;
}

TEST(StrokeRaster, PixelsAreThoseOfTheReference) {
    const Scene scene(lumpy());
    for (const char* texture : {"none", "charcoal"}) {
        LineStyle style;
        style.texture = texture;
        style.thickness = {.width = 6, .most = 9, .taper = 10};
        const DrawnLines drawn = draw(scene, LineType::contours, false, style);
        FloatImage expected(picture_width(), picture_height(), 3, 1.0f);
        draw_strokes(drawn_strokes(drawn), style, load_stroke_texture(texture), expected);
        double inked = 0, difference = 0, bias = 0;
        for (std::size_t i = 0; i < expected.data.size(); i += 3) {
            const double wanted = expected.data[i], actual = drawn.image.data[i] / 255.0;
            if (wanted > 0.99 && actual > 0.99) continue;
            inked += 1;
            difference += std::abs(wanted - actual);
            bias += wanted - actual;
        }
        EXPECT_GT(inked, 2000);
        EXPECT_LT(difference / inked, 0.05) << texture;
        EXPECT_LT(std::abs(bias) / inked, 0.02) << texture;
    }
}

INSTANTIATE_TEST_SUITE_P(AllTypes, StrokeParity, ::testing::ValuesIn(k_line_types),
                         [](const auto& type) { return std::string(name_of(type.param)); });

}  // namespace
}  // namespace exemplar
