#include "host/hatching/comparison/drawing_comparison.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/core/errors.h"

namespace exemplar {
namespace {

constexpr int k_sheet = 200;

/// Parallel lines of a pen through a square, `spacing` apart, at an angle in degrees.
ComparedDrawing hatched(float degrees, float spacing, float width, float left = 30, float right = 170) {
    ComparedDrawing drawing;
    drawing.darkness = FloatImage(k_sheet, k_sheet, 1);
    const float angle = degrees * std::numbers::pi_v<float> / 180;
    for (int y = 0; y < k_sheet; ++y)
        for (int x = 0; x < k_sheet; ++x) {
            const float px = static_cast<float>(x) + 0.5f, py = static_cast<float>(y) + 0.5f;
            const float across = -std::sin(angle) * px + std::cos(angle) * py;
            const float off = std::abs(across - spacing * std::round(across / spacing));
            const bool inside = px > left && px < right && py > 30 && py < 170;
            drawing.darkness.pixel(x, y)[0] = inside ? std::clamp(0.5f * width + 0.5f - off, 0.0f, 1.0f) : 0.0f;
        }
    drawing.strokes = measure_strokes(drawing.darkness, Image(k_sheet, k_sheet, 1, 1));
    return drawing;
}

PixelMask everywhere() {
    return PixelMask(k_sheet, k_sheet, 1, 1);
}

TEST(DrawingComparison, ADrawingIsLikeItself) {
    const ComparedDrawing drawing = hatched(20, 8, 2);
    const DrawingComparison c = compare_drawings(drawing, drawing, everywhere());
    EXPECT_GT(c.inked_by_both, 3000U);
    EXPECT_NEAR(c.direction_median, 0, 1e-4);
    EXPECT_EQ(c.direction_off, 0);
    EXPECT_EQ(c.region_overlap, 1);
    EXPECT_NEAR(c.level_right, 1, 1e-9);
    EXPECT_NEAR(c.level[0][0] + c.level[1][1], 1, 0.02);
    for (const double tone : c.tone) EXPECT_NEAR(tone, 1, 1e-9);
    for (std::size_t p = 0; p < k_stroke_properties; ++p) EXPECT_NEAR(c.factor[p], 1, 1e-6) << p;
}

TEST(DrawingComparison, TurnedStrokesAreOffByTheirAngle) {
    const ComparedDrawing artist = hatched(20, 8, 2);
    for (const float turn : {10.0f, 25.0f, 40.0f}) {
        const DrawingComparison c = compare_drawings(artist, hatched(20 + turn, 8, 2), everywhere());
        ASSERT_GT(c.inked_by_both, 300U);
        EXPECT_NEAR(c.direction_median, static_cast<double>(turn), 2.5) << turn;
        EXPECT_NEAR(c.direction_off, turn > 30 ? 1 : 0, 0.05) << turn;
    }
}

TEST(DrawingComparison, RatiosAreTheDrawingsOverTheArtists) {
    const DrawingComparison c = compare_drawings(hatched(0, 8, 2), hatched(0, 12, 3), everywhere());
    EXPECT_NEAR(c.ratio[static_cast<std::size_t>(StrokeProperty::spacing)], 1.5, 0.05);
    EXPECT_NEAR(c.factor[static_cast<std::size_t>(StrokeProperty::spacing)], 1.5, 0.05);
    EXPECT_NEAR(c.ratio[static_cast<std::size_t>(StrokeProperty::thickness)], 1.5, 0.1);
    const DrawingComparison back = compare_drawings(hatched(0, 12, 3), hatched(0, 8, 2), everywhere());
    EXPECT_NEAR(back.ratio[static_cast<std::size_t>(StrokeProperty::spacing)], 1 / 1.5, 0.05);
    EXPECT_NEAR(back.factor[static_cast<std::size_t>(StrokeProperty::spacing)], 1.5, 0.05);
}

TEST(DrawingComparison, RegionsOverlapByWhatBothHatch) {
    const DrawingComparison c = compare_drawings(hatched(0, 8, 2, 30, 130), hatched(0, 8, 2, 80, 180), everywhere());
    EXPECT_NEAR(c.region_overlap, 50.0 / 150, 0.03);
    EXPECT_LT(c.tone[0], 0.5);
    EXPECT_NEAR(c.hatched[0], 100.0 * 140 / (k_sheet * k_sheet), 0.03);
    EXPECT_NEAR(c.level[1][0], 50.0 * 140 / (k_sheet * k_sheet), 0.04);
}

TEST(DrawingComparison, OnlyTheMaskCounts) {
    PixelMask left(k_sheet, k_sheet, 1);
    for (int y = 0; y < k_sheet; ++y)
        for (int x = 0; x < 80; ++x) left.pixel(x, y)[0] = 1;
    const ComparedDrawing artist = hatched(0, 8, 2, 30, 75), drawing = hatched(0, 8, 2, 30, 170);
    EXPECT_GT(compare_drawings(artist, drawing, left).region_overlap, 0.85);
    EXPECT_LT(compare_drawings(artist, drawing, everywhere()).region_overlap, 0.4);
    EXPECT_THROW(compare_drawings(artist, drawing, PixelMask(k_sheet, k_sheet, 1)), DataError);
    EXPECT_THROW(compare_drawings(artist, drawing, PixelMask(k_sheet, 10, 1, 1)), UsageError);
}

TEST(DrawingComparison, BlankDrawingsAreCompared) {
    const ComparedDrawing artist = hatched(0, 8, 2);
    ComparedDrawing blank{FloatImage(k_sheet, k_sheet, 1), {}};
    blank.strokes = measure_strokes(blank.darkness, Image(k_sheet, k_sheet, 1, 1));
    const DrawingComparison c = compare_drawings(artist, blank, everywhere());
    EXPECT_EQ(c.inked_by_both, 0U);
    EXPECT_EQ(c.region_overlap, 0);
    EXPECT_EQ(c.tone[0], 0);
}

TEST(DrawingComparison, ThePictureIsGreenWhereStrokesAgreeAndRedWhereTheyDoNot) {
    const auto count = [](const Image& picture, bool red) {
        std::size_t pixels = 0;
        for (std::size_t i = 0; i < picture.data.size(); i += 3)
            pixels += red ? picture.data[i] > 150 && picture.data[i + 1] < 50 && picture.data[i + 2] < 50
                          : picture.data[i] < 50 && picture.data[i + 1] > 100 && picture.data[i + 2] < 80;
        return pixels;
    };
    const ComparedDrawing artist = hatched(0, 8, 2);
    const Image same = comparison_picture(artist, artist, everywhere());
    const Image across = comparison_picture(artist, hatched(45, 8, 2), everywhere());
    EXPECT_GT(count(same, false), 3000U);
    EXPECT_EQ(count(same, true), 0U);
    EXPECT_GT(count(across, true), 300U);
}

}  // namespace
}  // namespace exemplar
