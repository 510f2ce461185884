#include "host/hatching/drawing/drawing_input.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "host/core/errors.h"
#include "tests/hatching/measurement/test_drawings.h"

namespace exemplar {
namespace {

using namespace test;

FloatImage hatched(int width, int height, float tone) {
    std::vector<InkStroke> strokes;
    add_family({0.4f, 8, 2, tone, 150, 19}, {0.5f * static_cast<float>(width), 0.5f * static_cast<float>(height)},
               strokes);
    return ink_drawing(strokes, width, height);
}

TEST(DrawingDarkness, IsOneLessTheGrayOfADrawingOnWhite) {
    const FloatImage truth = hatched(200, 160, 0.8f);
    const FloatImage darkness = drawing_darkness(scanned(truth));
    ASSERT_EQ(darkness.width, 200);
    ASSERT_EQ(darkness.height, 160);
    for (std::size_t i = 0; i < truth.data.size(); ++i) ASSERT_NEAR(darkness.data[i], truth.data[i], 0.004);
}

TEST(DrawingDarkness, TakesColorsByTheirLightnessAndAlphaOverWhite) {
    Image rgb(60, 40, 3, 255), rgba(60, 40, 4, 0), gray(60, 40, 1, 255);
    for (int x = 5; x < 55; ++x) {
        rgb.pixel(x, 20)[0] = 10, rgb.pixel(x, 20)[1] = 20, rgb.pixel(x, 20)[2] = 120;
        rgba.pixel(x, 20)[3] = 128;
        gray.pixel(x, 20)[0] = 127;
    }
    const float blue = 1 - (0.2126f * 10 + 0.7152f * 20 + 0.0722f * 120) / 255;
    EXPECT_NEAR(drawing_darkness(rgb).pixel(30, 20)[0], blue, 0.004);
    const FloatImage transparent = drawing_darkness(rgba), half = drawing_darkness(gray);
    for (std::size_t i = 0; i < half.data.size(); ++i) ASSERT_NEAR(transparent.data[i], half.data[i], 1e-5);
}

TEST(DrawingDarkness, OfUnevenPaperIsZeroOnAverage) {
    const FloatImage truth = hatched(240, 240, 0.6f);
    const FloatImage darkness = drawing_darkness(scanned(truth, {0, 0.03f, 0.9f, 0.25f}));
    // The mean over blocks of paper, and the tone in the middle of strokes.
    for (int top = 0; top < 240; top += 40)
        for (int left = 0; left < 240; left += 40) {
            std::vector<float> paper, ink;
            for (int y = top; y < top + 40; ++y)
                for (int x = left; x < left + 40; ++x) {
                    if (truth.pixel(x, y)[0] == 0) paper.push_back(darkness.pixel(x, y)[0]);
                    if (truth.pixel(x, y)[0] > 0.59f) ink.push_back(darkness.pixel(x, y)[0]);
                }
            const auto mean = [](const std::vector<float>& values) {
                double sum = 0;
                for (const float value : values) sum += static_cast<double>(value);
                return sum / static_cast<double>(values.size());
            };
            EXPECT_NEAR(mean(paper), 0, 0.012) << left << ", " << top;
            if (ink.size() <= 30) continue;
            EXPECT_NEAR(mean(ink), 0.6, 0.03) << left << ", " << top;
        }
}

TEST(DrawingDarkness, RefusesWhatHasNoStrokesOrNoPaper) {
    const auto message = [](const Image& drawing) {
        try {
            drawing_darkness(drawing);
        } catch (const DataError& error) {
            return std::string(error.what());
        }
        return std::string("none");
    };
    EXPECT_THAT(message(Image(50, 40, 1, 255)), testing::HasSubstr("blank"));
    EXPECT_THAT(message(Image(50, 40, 4, 0)), testing::HasSubstr("blank"));
    EXPECT_THAT(message(Image(1, 1, 1, 255)), testing::HasSubstr("blank"));
    EXPECT_THAT(message(scanned(FloatImage(200, 200, 1), {0, 0.04f, 0.9f, 0.1f})), testing::HasSubstr("blank"));
    EXPECT_THAT(message(Image(50, 40, 1, 0)), testing::HasSubstr("dark all over"));
    std::vector<InkStroke> few;
    add_family({0.4f, 20, 2, 1, 100, 5}, {80, 80}, few);
    FloatImage negative = ink_drawing(few, 160, 160);
    for (float& value : negative.data) value = 1 - value;
    EXPECT_THAT(message(scanned(negative)), testing::HasSubstr("negative"));
    Image dot(50, 40, 1, 255);
    for (const int x : {20, 21, 22, 23, 24}) dot.pixel(x, 20)[0] = 0;
    EXPECT_EQ(message(dot), "none");
}

TEST(DrawingDarkness, RefusesWhatIsNoImage) {
    EXPECT_THROW(drawing_darkness(Image()), UsageError);
    EXPECT_THROW(drawing_darkness(Image(0, 0, 1)), UsageError);
    EXPECT_THROW(drawing_darkness(Image(5, 5, 2, 255)), UsageError);
}

}  // namespace
}  // namespace exemplar
