#include "host/lines/strokes/stroke_raster.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "host/core/errors.h"
#include "tests/lines/drawn_scene.h"

namespace exemplar {
namespace {

using namespace test_support;

Stroke straight(const Vec2& a, const Vec2& b, float width) {
    Stroke stroke;
    for (const Vec2& p : {a, b}) {
        StrokePoint& point = stroke.points.emplace_back();
        point.position = p;
        point.width = width;
        point.normal = Vec2(-(b - a).y(), (b - a).x()).normalized();
    }
    stroke.points.back().parameter = (b - a).norm();
    return stroke;
}

TEST(StrokePictures, CoverWhatTheFormulaSays) {
    FloatImage image(20, 10, 3, 1.0f);
    const Stroke stroke = straight({4, 5.25f}, {16, 5.25f}, 3);
    draw_strokes({&stroke, 1}, black(), {}, image);
    for (int y = 0; y < 10; ++y) {
        const float distance = std::abs(static_cast<float>(y) + 0.5f - 5.25f);
        EXPECT_NEAR(image.pixel(10, y)[0], 1 - std::clamp(2 - distance, 0.0f, 1.0f), 1e-5) << y;
    }
    EXPECT_EQ(image.pixel(1, 5)[0], 1);
}

TEST(StrokePictures, DrawAStrokeOnceAndStrokesInOrder) {
    LineStyle style = black();
    style.opacity = 0.5f;
    Stroke back_and_forth = straight({2, 5}, {18, 5}, 4);
    back_and_forth.points.push_back(back_and_forth.points.front());
    FloatImage image(20, 10, 3, 1.0f);
    draw_strokes({&back_and_forth, 1}, style, {}, image);
    EXPECT_NEAR(image.pixel(10, 5)[0], 0.5, 1e-6);
    const std::vector<Stroke> twice(2, back_and_forth);
    image = FloatImage(20, 10, 3, 1.0f);
    draw_strokes(twice, style, {}, image);
    EXPECT_NEAR(image.pixel(10, 5)[0], 0.25, 1e-6);
    Stroke hidden = straight({2, 5}, {18, 5}, 4);
    hidden.points[0].visible = false;
    draw_strokes({&hidden, 1}, style, {}, image);
    EXPECT_NEAR(image.pixel(10, 5)[0], 0.25, 1e-6);
}

TEST(StrokePictures, KeepTransparencyStraight) {
    FloatImage image(20, 10, 4, 0.0f);
    LineStyle style = black();
    style.color = {255, 0, 0};
    style.opacity = 0.5f;
    const Stroke stroke = straight({2, 5}, {18, 5}, 4);
    draw_strokes({&stroke, 1}, style, {}, image);
    EXPECT_NEAR(image.pixel(10, 5)[0], 1, 1e-6);  // its color, not darkened by what is not there
    EXPECT_NEAR(image.pixel(10, 5)[3], 0.5, 1e-6);
    EXPECT_EQ(image.pixel(1, 1)[3], 0);
    FloatImage gray(4, 4, 1);
    EXPECT_THROW(draw_strokes({&stroke, 1}, style, {}, gray), UsageError);
}

TEST(StrokePictures, LayTexturesAlongAndAcross) {
    // The right side of the way on, below, is opaque in every other 4 pixels.
    Image texture(8, 2, 1, 0);
    for (int x = 0; x < 4; ++x) texture.pixel(x, 1)[0] = 255;
    FloatImage image(40, 20, 3, 1.0f);
    const Stroke stroke = straight({4, 10}, {36, 10}, 12);
    draw_strokes({&stroke, 1}, black(), texture, image);
    for (int period = 0; period < 4; ++period) {
        EXPECT_NEAR(image.pixel(4 + 8 * period + 2, 14)[0], 0, 1e-5);
        EXPECT_NEAR(image.pixel(4 + 8 * period + 6, 14)[0], 1, 1e-5);
        EXPECT_NEAR(image.pixel(4 + 8 * period + 2, 5)[0], 1, 1e-5);
    }
}

}  // namespace
}  // namespace exemplar
