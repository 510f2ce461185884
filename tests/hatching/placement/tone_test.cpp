#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <vector>

#include "host/core/errors.h"
#include "host/core/parallel.h"
#include "host/core/random.h"
#include "host/hatching/fields/ink.h"
#include "host/hatching/placement/streamlines.h"
#include "host/hatching/refinement/stroke_statistics.h"
#include "host/hatching/refinement/tone_matching.h"
#include "tests/support/hatching_scenes.h"

namespace exemplar {
namespace {

using namespace test_support;

HatchStroke line(const Vec2& from, const Vec2& to, float width, float darkness = 1, std::size_t layer = 0) {
    HatchStroke stroke{.layer = layer, .points = {}, .widths = {}, .darkness = darkness};
    const int count = std::max(1, static_cast<int>((to - from).norm() / 2));
    for (int i = 0; i <= count; ++i)
        stroke.points.push_back(from + static_cast<float>(i) / static_cast<float>(count) * (to - from));
    stroke.widths.assign(stroke.points.size(), width);
    return stroke;
}

double sum(const std::vector<float>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0);
}

TEST(Ink, OfAStrokeIsItsArea) {
    constexpr double k_half_turn = std::numbers::pi;
    for (const float width : {0.4f, 1.0f, 1.1f, 3.7f})
        for (const float angle : {0.0f, 0.5f, 1.5707963f}) {
            const Vec2 half = 40 * Vec2(std::cos(angle), std::sin(angle)), middle(50.3f, 49.8f);
            const auto ink = render_ink(std::vector{line(middle - half, middle + half, width, 0.5f)}, 100, 100);
            const double w = static_cast<double>(width), area = 80 * w + k_half_turn * w * w / 4;
            // Sixteen places of a pixel: along an axis they are a sixteenth of a pixel apart.
            EXPECT_NEAR(sum(ink), 0.5 * area, 0.5 * (0.005 * area + 80.0 / 16)) << width << " " << angle;
        }
}

TEST(Ink, DarkensWhereStrokesCrossButNotWhereOneDoes) {
    const std::vector cross{line({2, 10.5f}, {18, 10.5f}, 6, 0.5f), line({10.5f, 2}, {10.5f, 18}, 6, 0.4f)};
    const auto ink = render_ink(cross, 21, 21);
    EXPECT_FLOAT_EQ(ink[10 * 21 + 10], 1 - 0.5f * 0.6f);
    EXPECT_FLOAT_EQ(ink[10 * 21 + 4], 0.5f);
    EXPECT_FLOAT_EQ(ink[4 * 21 + 10], 0.4f);
    EXPECT_FLOAT_EQ(ink[0], 0);
    HatchStroke folded = line({2, 10.5f}, {18, 10.5f}, 6, 0.5f);
    folded.points.insert(folded.points.end(), folded.points.rbegin(), folded.points.rend());
    folded.widths.assign(folded.points.size(), 6.0f);
    EXPECT_FLOAT_EQ(render_ink(std::vector{folded}, 21, 21)[10 * 21 + 10], 0.5f);
}

TEST(Ink, MayLeaveThePicture) {
    const auto ink = render_ink(std::vector{line({-50, 5.5f}, {80, 5.5f}, 3)}, 20, 10);
    EXPECT_FLOAT_EQ(ink[5 * 20], 1);
    EXPECT_FLOAT_EQ(ink[5 * 20 + 19], 1);
    EXPECT_FLOAT_EQ(ink[0], 0);
    EXPECT_TRUE(render_ink(std::vector{line({0, 0}, {1, 1}, 1)}, 0, 0).empty());
    HatchStroke bad = line({0, 0}, {9, 1}, 1);
    bad.widths.pop_back();
    EXPECT_THROW(render_ink(std::vector{bad}, 20, 10), UsageError);
    bad = line({0, 0}, {9, 1}, 1);
    bad.points.back().y() = std::numeric_limits<float>::infinity();
    EXPECT_THROW(render_ink(std::vector{bad}, 20, 10), UsageError);
}

TEST(Ink, MeansOverWindowsAreMeans) {
    Random random(3);
    constexpr int k_width = 23, k_height = 17;
    std::vector<float> values(k_width * k_height);
    for (float& value : values) value = static_cast<float>(random.uniform());
    const WindowMeans means(values, k_width, k_height);
    for (const int reach : {0, 1, 5, 100}) {
        for (int y = 0; y < k_height; ++y)
            for (int x = 0; x < k_width; ++x) {
                double total = 0, count = 0;
                for (int j = std::max(0, y - reach); j <= std::min(k_height - 1, y + reach); ++j)
                    for (int i = std::max(0, x - reach); i <= std::min(k_width - 1, x + reach); ++i) {
                        total += static_cast<double>(
                            values[static_cast<std::size_t>(j) * k_width + static_cast<std::size_t>(i)]);
                        ++count;
                    }
                ASSERT_NEAR(means.mean(x, y, reach), total / count, 1e-9);
            }
    }
}

TEST(StrokeStatistics, MeasureLinesAsFarAsTheyAre) {
    const HatchingFields fields = even_fields(100, 100, 0, 6);
    for (const float apart : {4.5f, 6.0f, 9.0f}) {
        std::vector<HatchStroke> strokes;
        for (float y = 10; y < 90; y += apart) strokes.push_back(line({5, y}, {95, y}, 1));
        const SpacingMeasure measure = measure_spacing(strokes, fields);
        const double ratio = static_cast<double>(apart) / 6;
        EXPECT_NEAR(measure.mean_ratio, ratio, 1e-4);
        EXPECT_NEAR(measure.median_error, std::abs(ratio - 1), 1e-4);
        EXPECT_NEAR(measure.min_ratio, std::min(ratio, 1.0), 1e-4);
        EXPECT_EQ(measure.gaps, 2 * (strokes.size() - 1) * strokes[0].points.size());
    }
}

TEST(StrokeStatistics, MeasureWithinALayerAndARegion) {
    HatchingFields fields = even_fields(100, 100, 0, 6);
    std::ranges::fill(fields.level, k_cross_hatching);
    const std::vector strokes{line({5, 40}, {95, 40}, 1), line({5, 43}, {95, 43}, 1, 1, 1), line({5, 47}, {95, 47}, 1)};
    EXPECT_NEAR(measure_spacing(strokes, fields).mean_ratio, 7.0 / 6, 1e-4);
    for (int x = 0; x < 100; ++x) fields.level[fields.index(x, 44)] = k_no_hatching;
    EXPECT_EQ(measure_spacing(strokes, fields).gaps, 0u);
    EXPECT_THROW(measure_spacing(std::vector{line({0, 0}, {9, 1}, 1, 1, 2)}, fields), UsageError);
}

TEST(StrokeStatistics, MeasureTones) {
    const HatchingFields fields = even_fields(100, 100, 0, 6);
    std::vector<HatchStroke> strokes;
    for (float y = 3.3f; y < 100; y += 6) strokes.push_back(line({-5, y}, {105, y}, 1.5f));
    EXPECT_LT(measure_tone(strokes, fields).median_error, 0.07);
    EXPECT_NEAR(measure_tone(strokes, fields).mean_ratio, 1, 0.03);
    for (HatchStroke& stroke : strokes) std::ranges::fill(stroke.widths, 3.0f);
    EXPECT_NEAR(measure_tone(strokes, fields).mean_ratio, 2, 0.06);
    EXPECT_NEAR(measure_tone(strokes, fields).median_error, 1, 0.1);
}

TEST(TargetTone, IsThatOfBothLayers) {
    HatchingFields fields = even_fields(3, 1, 0, 6);
    fields.intensity[1] = 0.5f;
    fields.level = {k_single_hatching, k_cross_hatching, k_no_hatching};
    const auto tone = target_tone(fields);
    EXPECT_FLOAT_EQ(tone[0], 0.25f);
    EXPECT_FLOAT_EQ(tone[1], 1 - 0.875f * 0.875f);
    EXPECT_FLOAT_EQ(tone[2], 0);
    fields.thickness[0] = 20;
    EXPECT_FLOAT_EQ(target_tone(fields)[0], 1);
}

class ToneMatching : public ::testing::TestWithParam<int> {};

TEST_P(ToneMatching, BringsDrawingsToTheirTone) {
    HatchingFields fields = GetParam() == 0 ? even_fields(250, 250, 0.4f) : wavy_fields(300, 220, GetParam());
    if (GetParam() == 0) {
        for_pixels(fields, [&](std::size_t i, float x, float y) {
            fields.level[i] = y > 150 ? k_cross_hatching : k_single_hatching;
            fields.thickness[i] = 0.8f + 0.01f * x;
        });
    }
    auto strokes = CpuStrokePlacer().place(fields, {}, {.test_distance = 0.7f});
    const auto before = strokes;
    const double untouched = measure_tone(strokes, fields).median_error;
    match_tone(strokes, fields);
    const ToneMeasure measure = measure_tone(strokes, fields);
    EXPECT_LT(measure.median_error, 0.1);
    EXPECT_LT(measure.median_error, 0.7 * untouched);
    EXPECT_NEAR(measure.mean_ratio, 1, 0.04);
    for (std::size_t i = 0; i < strokes.size(); ++i) {
        EXPECT_EQ(strokes[i].points, before[i].points);
        for (std::size_t j = 0; j < strokes[i].widths.size(); ++j) {
            const float factor = strokes[i].widths[j] / before[i].widths[j];
            EXPECT_GE(factor, k_min_width_factor - 1e-5f);
            EXPECT_LE(factor, k_max_width_factor + 1e-5f);
            const float last = j > 0 ? strokes[i].widths[j - 1] / before[i].widths[j - 1] : factor;
            EXPECT_LT(std::abs(factor - last), 0.3f);
        }
    }
    // Matched again, it is near the same: factors are of the thickness, not of what was made of it.
    auto again = strokes;
    match_tone(again, fields);
    for (std::size_t i = 0; i < strokes.size(); ++i)
        for (std::size_t j = 0; j < strokes[i].widths.size(); ++j)
            EXPECT_LE(again[i].widths[j], (k_max_width_factor + 1e-4f) * before[i].widths[j]);
}

INSTANTIATE_TEST_SUITE_P(Scenes, ToneMatching, ::testing::Range(0, 4));

TEST(ToneMatching, IsTheSameOnAnyNumberOfThreads) {
    const HatchingFields fields = wavy_fields(200, 150, 8);
    const auto placed = CpuStrokePlacer().place(fields);
    std::vector<std::vector<HatchStroke>> results;
    for (const std::size_t threads : {1u, 3u}) {
        const ThreadLimit limit(threads);
        results.push_back(placed);
        match_tone(results.back(), fields);
    }
    EXPECT_EQ(results[0], results[1]);
}

TEST(ToneMatching, TakesNothing) {
    std::vector<HatchStroke> none;
    match_tone(none, HatchingFields());
    match_tone(none, even_fields(10, 10, 0));
    EXPECT_TRUE(none.empty());
    EXPECT_THROW(match_tone(none, even_fields(10, 10, 0), -1), UsageError);
}

}  // namespace
}  // namespace exemplar
