#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <vector>

#include "host/core/errors.h"
#include "host/hatching/fields/occlusion_barriers.h"
#include "host/hatching/placement/streamlines.h"
#include "host/hatching/refinement/stroke_statistics.h"
#include "tests/support/hatching_scenes.h"
#include "tests/support/stroke_checks.h"

namespace exemplar {
namespace {

using namespace test_support;

/// The share of strokes in `before` that are among `after`, but for a tenth of a pixel of each point and its ends.
double kept_share(const std::vector<HatchStroke>& before, const std::vector<HatchStroke>& after) {
    std::size_t kept = 0;
    for (const HatchStroke& old : before)
        kept += std::ranges::any_of(after, [&](const HatchStroke& stroke) {
            return stroke.layer == old.layer && (stroke.points.front() - old.points.front()).norm() < 2 &&
                   (stroke.points.back() - old.points.back()).norm() < 2;
        });
    return static_cast<double>(kept) / static_cast<double>(before.size());
}

TEST(KeptStrokes, StayInAPictureThatDoesNotChange) {
    const HatchingFields fields = wavy_fields(300, 200, 3);
    CpuStrokePlacer placer;
    const auto before = placer.place(fields);
    const auto after = placer.place(fields, {}, {}, before);
    EXPECT_GT(kept_share(before, after), 0.97);
    EXPECT_NEAR(static_cast<double>(after.size()), static_cast<double>(before.size()),
                0.05 * static_cast<double>(before.size()));
    EXPECT_GT(measure_spacing(after, fields).min_ratio, 0.6);
}

TEST(KeptStrokes, EndWhereTheyAreNoLongerRight) {
    HatchingFields fields = even_fields(200, 200, 0.3f);
    CpuStrokePlacer placer;
    const StrokeOptions options{.test_distance = 0.7f};
    const auto before = placer.place(fields, {}, options);
    std::vector<std::uint8_t> barriers(fields.size());
    for_pixels(fields, [&](std::size_t i, float x, float y) {
        if (std::hypot(x - 60, y - 60) < 30) fields.level[i] = k_no_hatching;
        if (x > 150) fields.orientation[0][i] = 1.2f;
        if (x == 100.5f) barriers[i] = k_barrier_right;
    });
    const auto after = placer.place(fields, barriers, options, before);
    for (const HatchStroke& stroke : after) {
        for (const Vec2& point : stroke.points) {
            ASSERT_GT(fields.level[pixel_of(fields, point)], 0);
            ASSERT_EQ(point.x() < 101, stroke.points[0].x() < 101);
        }
        const Vec2 way = (stroke.points.back() - stroke.points.front()).normalized();
        if (stroke.points.front().x() > 151 && stroke.points.back().x() > 151) {
            EXPECT_GT(std::abs(way.dot(Vec2(std::cos(1.2f), std::sin(1.2f)))), 0.9f);
        }
    }
    EXPECT_GE(measure_spacing(after, fields).min_ratio, 0.69);
    EXPECT_LT(empty_share(after, fields, 0, 1.5f), 0.02);
}

/// A kept stroke along x.
HatchStroke row(float y, float from, float to) {
    HatchStroke stroke{.layer = 0, .points = {}, .widths = {}, .darkness = 1};
    for (float x = from; x <= to; x += 2) stroke.points.emplace_back(x, y);
    stroke.widths.assign(stroke.points.size(), 1.0f);
    return stroke;
}

TEST(KeptStrokes, GiveWayInTheirOrder) {
    const HatchingFields fields = even_fields(100, 100, 0, 6, 50);
    const std::vector<HatchStroke> kept{row(50, 20, 70), row(52, 30, 80), row(53, 78, 99)};
    const auto strokes = CpuStrokePlacer().place(fields, {}, {.test_distance = 0.7f}, kept);
    ASSERT_GT(strokes.size(), 2u);
    EXPECT_LT((strokes[0].points.front() - Vec2(20, 50)).norm(), 0.1f);
    EXPECT_LT((strokes[0].points.back() - Vec2(70, 50)).norm(), 1.1f);
    // The second has no more than nine pixels that are far enough from the first. The third grows back until it comes
    // within 0.7 of the spacing of the first.
    EXPECT_NEAR(strokes[1].points.front().x(), 70 + std::sqrt(4.2f * 4.2f - 9), 2);
    EXPECT_NEAR(strokes[1].points.front().y(), 53, 0.1f);
    EXPECT_GT(strokes[1].points.back().x(), 97);
    EXPECT_GE(measure_spacing(strokes, fields).min_ratio, 0.69);
}

TEST(KeptStrokes, GrowBackToTheirTargets) {
    HatchingFields fields = even_fields(200, 60, 0);
    CpuStrokePlacer placer;
    std::vector<std::uint8_t> barriers(fields.size());
    const auto grown = [&](float from, float to) {
        const HatchStroke stroke = row(30.5f, from, to);
        return placer.place(fields, barriers, {}, std::span(&stroke, 1))[0];
    };
    // At their ends, to the target of 60 pixels less the jitter of a tenth; they do not move.
    const HatchStroke free = grown(80, 110);
    EXPECT_NEAR(length_of(free), 54, 1.1f);
    EXPECT_NEAR(free.points.front().x(), 80, 0.1f);
    EXPECT_NEAR(length_of(grown(80, 136)), 56, 1.1f);
    // No farther than a barrier and the end of the layer.
    for_pixels(fields, [&](std::size_t i, float x, float) {
        if (x == 120.5f) barriers[i] = k_barrier_right;
        if (x < 75) fields.level[i] = k_no_hatching;
    });
    const HatchStroke bounded = grown(80, 110);
    EXPECT_NEAR(bounded.points.front().x(), 75, 1.1f);
    EXPECT_NEAR(bounded.points.back().x(), 121, 1.1f);
}

TEST(KeptStrokes, DoNotGrowIntoThemselves) {
    const HatchingFields fields = circle_fields(60, 60, 400);
    HatchStroke stroke{.layer = 0, .points = {}, .widths = {}, .darkness = 1};
    for (float angle = 0; angle < 2; angle += 0.1f)
        stroke.points.emplace_back(30 + 20 * std::cos(angle), 30 + 20 * std::sin(angle));
    const auto strokes = CpuStrokePlacer().place(fields, {}, {}, std::span(&stroke, 1));
    // Once around, less the test distance.
    EXPECT_NEAR(length_of(strokes[0]), 2 * std::numbers::pi_v<float> * 20 - 4.2f, 3);
}

TEST(KeptStrokes, AreCutWhereTheyAreMuchTooLong) {
    HatchingFields fields = even_fields(200, 60, 0, 6, 100);
    CpuStrokePlacer placer;
    HatchStroke stroke{.layer = 0, .points = {{50, 30}, {150, 30}}, .widths = {1, 1}, .darkness = 1};
    const auto kept_length = [&](float target) {
        std::ranges::fill(fields.length, target);
        return length_of(placer.place(fields, {}, {}, std::span(&stroke, 1))[0]);
    };
    EXPECT_NEAR(kept_length(100), 100, 1.1f);
    EXPECT_NEAR(kept_length(85), 100, 1.1f);
    EXPECT_NEAR(kept_length(70), 70, 1.1f);
}

TEST(KeptStrokes, MayBeAnywhereButNotAnything) {
    const HatchingFields fields = even_fields(60, 60, 0.2f);
    CpuStrokePlacer placer;
    HatchStroke stroke{.layer = 0, .points = {{-1e8f, 1e9f}, {1e30f, 3e8f}}, .widths = {1, 1}, .darkness = 1};
    EXPECT_EQ(placer.place(fields, {}, {}, std::span(&stroke, 1)), placer.place(fields));
    // Nor across what is asked for.
    const StrokeOptions any{.max_deviation = std::numbers::pi_v<float> / 2};
    EXPECT_EQ(placer.place(fields, {}, any, std::span(&stroke, 1)), placer.place(fields, {}, any));
    stroke.points.clear();
    EXPECT_EQ(placer.place(fields, {}, {}, std::span(&stroke, 1)), placer.place(fields));
    stroke.points = {{1, 1}, {std::numeric_limits<float>::quiet_NaN(), 1}};
    EXPECT_THROW(placer.place(fields, {}, {}, std::span(&stroke, 1)), UsageError);
    stroke = {.layer = 2, .points = {{1, 1}, {9, 1}}, .widths = {1, 1}, .darkness = 1};
    EXPECT_THROW(placer.place(fields, {}, {}, std::span(&stroke, 1)), UsageError);
}

}  // namespace
}  // namespace exemplar
