#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <vector>

#include "host/core/errors.h"
#include "host/hatching/property_pictures.h"
#include "tests/hatching/test_drawings.h"

namespace exemplar {
namespace {

using namespace test;

std::array<int, 3> color_at(const Image& image, std::size_t i) {
    return {image.data[3 * i], image.data[3 * i + 1], image.data[3 * i + 2]};
}

TEST(PropertyPictures, ShowWhatWasMeasured) {
    std::vector<InkStroke> strokes;
    add_family({0.2f, 7, 1.5f, 0.9f, 130, 9}, {100, 45}, strokes);
    add_family({0.2f, 12, 3, 0.5f, 130, 5}, {100, 150}, strokes);
    add_family({1.7f, 7, 1.5f, 0.9f, 60, 9}, {100, 45}, strokes);
    const FloatImage darkness = ink_drawing(strokes, 200, 200);
    const StrokeMeasurements m = measure_strokes(darkness, Image(200, 200, 1, 1));
    std::map<std::string, PropertyPicture> pictures;
    for (PropertyPicture& picture : property_pictures(m, darkness)) {
        EXPECT_EQ(picture.image.width, 200);
        EXPECT_EQ(picture.image.channels, 3);
        pictures[picture.name] = std::move(picture);
    }
    ASSERT_EQ(pictures.size(), 9u);
    for (const char* name : {"thickness", "spacing", "length", "intensity"})
        EXPECT_LT(pictures[name].low, pictures[name].high) << name;
    EXPECT_NEAR(pictures["thickness"].low, 1.5, 0.2);
    EXPECT_NEAR(pictures["thickness"].high, 3, 0.2);
    EXPECT_NEAR(pictures["spacing"].high, 12, 0.6);
    // Ramps grow darker with the value.
    const auto lightness = [&](const char* name, std::size_t i) {
        const auto [r, g, b] = color_at(pictures[name].image, i);
        return 0.2126 * r + 0.7152 * g + 0.0722 * b;
    };
    std::size_t thin = 0, thick = 0;
    for (std::size_t i = 0; i < m.size(); ++i) {
        if (!m.stroke[i]) {
            EXPECT_EQ(color_at(pictures["orientation"].image, i), (std::array{255, 255, 255}));
            continue;
        }
        if (m.thickness[i] < 1.6f) thin = i;
        if (m.thickness[i] > 2.9f) thick = i;
    }
    EXPECT_GT(lightness("thickness", thin), lightness("thickness", thick) + 60);
    EXPECT_GT(lightness("spacing", thin), lightness("spacing", thick) + 60);
    std::map<int, std::array<int, 3>> level_color;
    for (std::size_t i = 0; i < m.size(); ++i) {
        const auto color = color_at(pictures["level"].image, i);
        EXPECT_EQ(level_color.emplace(m.level[i], color).first->second, color);
    }
    EXPECT_EQ(level_color.size(), 3u);
}

TEST(PropertyPictures, OfNothingAreBlankAndOfAnotherDrawingRefused) {
    const FloatImage darkness(30, 20, 1);
    const StrokeMeasurements m = measure_strokes(darkness, Image(30, 20, 1, 1));
    for (const PropertyPicture& picture : property_pictures(m, darkness)) {
        EXPECT_THAT(picture.image.data, testing::Each(255)) << picture.name;
        EXPECT_EQ(picture.low, picture.high);
    }
    EXPECT_THROW(property_pictures(m, FloatImage(20, 30, 1)), UsageError);
}

}  // namespace
}  // namespace exemplar
