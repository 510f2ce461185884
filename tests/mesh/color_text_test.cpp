#include "host/mesh/color_text.h"

#include <gtest/gtest.h>

namespace exemplar {
namespace {

TEST(ColorText, HexadecimalColorsAreReadAndWritten) {
    EXPECT_EQ(hex_of_color({1, 171, 255}), "#01abff");
    EXPECT_EQ(color_of_hex("#01ABff"), (Color{1, 171, 255}));
    EXPECT_EQ(color_of_hex("#1af"), (Color{17, 170, 255}));
    for (const char* text :
         {"", "#", "#12345", "123456#", "#12345g", "#1234567", "#+12345", "#-1-1-1", "#-12", "# 12", "red"})
        EXPECT_FALSE(color_of_hex(text)) << text;
}

}  // namespace
}  // namespace exemplar
