#include "host/hatching/hatching_drawing.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <numbers>
#include <numeric>
#include <vector>

namespace exemplar {
namespace {

using Rgb = std::array<int, 3>;
constexpr Rgb k_white{255, 255, 255};

Rgb color_at(const Image& image, std::size_t i) {
    return {image.data[3 * i], image.data[3 * i + 1], image.data[3 * i + 2]};
}

TEST(PropertyPicture, GrowsDarkerWithTheValue) {
    std::vector<float> values(200);
    std::iota(values.begin(), values.end(), 0.0f);
    std::vector<std::uint8_t> known(200, 1);
    known[50] = 0;
    const std::array<float, 2> range = property_range(values, known);
    const Image image = property_picture(values, known, 20, 10, range);
    EXPECT_EQ(image.width, 20);
    EXPECT_NEAR(range[0], 1, 1);
    EXPECT_NEAR(range[1], 198, 1);
    EXPECT_EQ(color_at(image, 50), k_white);
    for (const std::size_t i : {21U, 100U, 160U}) EXPECT_GT(color_at(image, i)[0], color_at(image, i + 30)[0]);
    // Of one value, and of none.
    const std::vector<float> same(4, 2.0f);
    const std::vector<std::uint8_t> nowhere(4, 0);
    EXPECT_EQ(property_range(same, std::vector<std::uint8_t>(4, 1)), (std::array{2.0f, 2.0f}));
    EXPECT_EQ(property_range(same, nowhere), (std::array{0.0f, 0.0f}));
    const Image none = property_picture(same, nowhere, 2, 2, {2, 2});
    for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(color_at(none, i), k_white);
}

TEST(OrientationPicture, HasAHueForEachDirectionWithoutItsSign) {
    constexpr float k_half_turn = std::numbers::pi_v<float>;
    const std::vector<float> angles{0, 0.5f * k_half_turn, 0.25f * k_half_turn, 0.9999f * k_half_turn, 1};
    const Image image = orientation_picture(angles, std::vector<std::uint8_t>{1, 1, 1, 1, 0}, 5, 1);
    EXPECT_NE(color_at(image, 0), color_at(image, 1));
    EXPECT_NE(color_at(image, 0), color_at(image, 2));
    EXPECT_NE(color_at(image, 1), color_at(image, 2));
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(color_at(image, 0)[c], color_at(image, 3)[c], 2);
    EXPECT_EQ(color_at(image, 4), k_white);
}

TEST(LabelPicture, HasAColorForEachLabelButNone) {
    const Image image = label_picture(std::vector<std::uint8_t>{0, 1, 2, 1}, 0, 2, 2);
    EXPECT_EQ(color_at(image, 0), k_white);
    EXPECT_EQ(color_at(image, 1), color_at(image, 3));
    EXPECT_NE(color_at(image, 1), color_at(image, 2));
    EXPECT_NE(color_at(image, 1), k_white);
}

}  // namespace
}  // namespace exemplar
