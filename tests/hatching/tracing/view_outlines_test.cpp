#include "host/hatching/tracing/view_outlines.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "host/hatching/fields/hatching_fields.h"
#include "host/hatching/tracing/drawing_filters.h"

namespace exemplar {
namespace {

constexpr int k_disc_size = 120;
constexpr float k_disc_radius = 45, k_disc_center = 60;

/// A flat disc before nothing.
GBuffer flat_disc() {
    GBuffer gbuffer;
    gbuffer.width = gbuffer.height = k_disc_size;
    for (int y = 0; y < k_disc_size; ++y)
        for (int x = 0; x < k_disc_size; ++x) {
            const bool on = std::hypot(static_cast<float>(x) + 0.5f - k_disc_center,
                                       static_cast<float>(y) + 0.5f - k_disc_center) < k_disc_radius;
            gbuffer.face.push_back(on ? 0 : k_no_face);
            gbuffer.barycentric.push_back({});
            gbuffer.depth.push_back(on ? 3 : std::numeric_limits<float>::infinity());
        }
    return gbuffer;
}

TracedStroke stroke_between(const Vec2& from, const Vec2& to) {
    TracedStroke stroke;
    stroke.width = 2;
    const auto steps = static_cast<int>((to - from).norm());
    for (int k = 0; k <= steps; ++k) {
        TracedPoint point;
        point.center = from + (to - from) * (static_cast<float>(k) / static_cast<float>(steps));
        stroke.points.push_back(point);
    }
    orient_along(stroke);
    return stroke;
}

/// A circle around the disc's center, `share` of it.
TracedStroke arc(float radius, float share) {
    TracedStroke stroke;
    stroke.width = 2;
    const float steps = 2 * std::numbers::pi_v<float> * radius;
    for (float k = 0; k < share * steps; ++k) {
        TracedPoint point;
        const float angle = k / radius;
        point.center = Vec2(k_disc_center + radius * std::cos(angle), k_disc_center + radius * std::sin(angle));
        stroke.points.push_back(point);
    }
    orient_along(stroke);
    return stroke;
}

Vec2 on_circle(float radius, float angle) {
    return {k_disc_center + radius * std::cos(angle), k_disc_center + radius * std::sin(angle)};
}

TEST(ViewOutlines, RunAlongTheBorderOfADisc) {
    const ViewOutlines outlines = view_outlines(flat_disc());
    EXPECT_NEAR(static_cast<double>(outlines.count), 2 * std::numbers::pi * 44.5, 60);
    for (float angle = 0; angle < 6; angle += 0.4f) {
        const Vec2 place = on_circle(30, angle);
        const auto pixel = static_cast<std::size_t>(place.y()) * k_disc_size + static_cast<std::size_t>(place.x());
        EXPECT_NEAR(outlines.distance(pixel), 14.5, 1.2) << angle;
        const float along = outlines.direction[static_cast<std::size_t>(outlines.nearest[pixel])];
        EXPECT_LT(
            orientation_difference(along, std::fmod(angle + std::numbers::pi_v<float> / 2, std::numbers::pi_v<float>)),
            0.15f)
            << angle;
    }
}

TEST(ViewOutlines, NothingHasNone) {
    GBuffer gbuffer = flat_disc();
    for (float& depth : gbuffer.depth) depth = std::numeric_limits<float>::infinity();
    const ViewOutlines outlines = view_outlines(gbuffer);
    EXPECT_EQ(outlines.count, 0U);
    EXPECT_EQ(outlines.distance(500), std::numeric_limits<float>::infinity());
}

TEST(TakeOutlines, HatchesThatMeetTheOutlineStay) {
    // An outline a pixel and a half beside its place, and hatches that end at it at angles from 90 to 40 degrees.
    std::vector<TracedStroke> strokes{arc(43.5f, 1)};
    for (int k = 0; k < 12; ++k) {
        const float angle = 0.5f * static_cast<float>(k);
        strokes.push_back(stroke_between(on_circle(44, angle), on_circle(28, angle + 0.05f * static_cast<float>(k))));
    }
    const std::vector<TracedStroke> drawn = take_outlines(strokes, view_outlines(flat_disc()), 3.5f);
    ASSERT_EQ(drawn.size(), 1U);
    EXPECT_GT(drawn[0].points.size(), 260U);
    ASSERT_EQ(strokes.size(), 12U);
    for (const TracedStroke& stroke : strokes) EXPECT_GT(stroke.points.size(), 13U);
}

TEST(TakeOutlines, AHatchThatEndsInTheOutlineIsCutFromIt) {
    std::vector<TracedStroke> strokes{arc(44, 0.8f)};
    TracedStroke inward = stroke_between(strokes[0].points.back().center, Vec2(k_disc_center, k_disc_center));
    strokes[0].points.insert(strokes[0].points.end(), inward.points.begin() + 1, inward.points.end());
    orient_along(strokes[0]);
    const std::vector<TracedStroke> drawn = take_outlines(strokes, view_outlines(flat_disc()), 3.5f);
    ASSERT_EQ(drawn.size(), 1U);
    ASSERT_EQ(strokes.size(), 1U);
    EXPECT_NEAR(static_cast<double>(strokes[0].points.size()), 42, 6);
}

TEST(TakeOutlines, HatchingAlongTheBorderIsNoOutline) {
    // A third of the outline is no outline drawn by hand, but hatching that runs along it.
    std::vector<TracedStroke> strokes{arc(43, 0.35f), arc(38, 0.35f)};
    EXPECT_TRUE(take_outlines(strokes, view_outlines(flat_disc()), 3.5f).empty());
    EXPECT_EQ(strokes.size(), 2U);
    // Beside a drawn outline, only the outermost line counts as one.
    strokes = {arc(44, 1), arc(38, 1), arc(33, 1)};
    EXPECT_EQ(take_outlines(strokes, view_outlines(flat_disc()), 3.5f).size(), 1U);
    EXPECT_EQ(strokes.size(), 2U);
}

}  // namespace
}  // namespace exemplar
