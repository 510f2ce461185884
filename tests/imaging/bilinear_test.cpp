#include "host/imaging/bilinear.h"

#include <gtest/gtest.h>

namespace exemplar {
namespace {

/// 3 x 2 pixels.
FloatImage ramp() {
    FloatImage image(3, 2, 1);
    image.data = {1, 2, 4, 3, 6, 5};
    return image;
}

TEST(SampleBilinear, IsThePixelAtItsCenterAndTheMeanBetweenFour) {
    for (const ImageBorder border : {ImageBorder::zero, ImageBorder::nearest}) {
        for (int y = 0; y < 2; ++y)
            for (int x = 0; x < 3; ++x)
                EXPECT_EQ(sample_bilinear(ramp(), {static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f}, border),
                          ramp().pixel(x, y)[0]);
        EXPECT_EQ(sample_bilinear(ramp(), {1, 1}, border), 3);
        EXPECT_EQ(sample_bilinear(ramp(), {1.75f, 0.5f}, border), 2.5f);
    }
}

TEST(SampleBilinear, FadesToZeroBeyondTheBorderOrRepeatsIt) {
    EXPECT_EQ(sample_bilinear(ramp(), {3, 0.5f}, ImageBorder::zero), 2);
    EXPECT_EQ(sample_bilinear(ramp(), {3, 0.5f}, ImageBorder::nearest), 4);
    EXPECT_EQ(sample_bilinear(ramp(), {0, 0}, ImageBorder::zero), 0.25f);
    EXPECT_EQ(sample_bilinear(ramp(), {0, 0}, ImageBorder::nearest), 1);
    for (const Vec2& far : {Vec2(-1, 1), Vec2(4, 1), Vec2(1, -7), Vec2(1, 1e9f)})
        EXPECT_EQ(sample_bilinear(ramp(), far, ImageBorder::zero), 0);
    EXPECT_EQ(sample_bilinear(ramp(), {1e9f, 1e9f}, ImageBorder::nearest), 5);
}

}  // namespace
}  // namespace exemplar
