#include "host/imaging/pictures/tiff.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "host/core/errors.h"
#include "host/core/files.h"
#include "host/imaging/pictures/group4.h"
#include "host/imaging/pictures/packed_bytes.h"
#include "host/imaging/pictures/picture_file.h"
#include "tests/support/temporary_folder.h"

namespace exemplar {
namespace {

using testing::HasSubstr;

constexpr int k_width = 24, k_height = 16;

/// The gray and the color of each pixel in the corpus files that were made with libtiff.
std::uint8_t gray_at(int x, int y) {
    return static_cast<std::uint8_t>((8 * x + 4 * y) % 256);
}
std::array<std::uint8_t, 4> color_at(int x, int y) {
    return {gray_at(x, y), gray_at(x, k_height - 1 - y), static_cast<std::uint8_t>(255 - gray_at(x, y)),
            gray_at(k_width - 1 - x, y)};
}

const std::filesystem::path k_files = "tests/fuzz/corpus/tiff";

/// The page of a file of the corpus.
Image read_one(const std::string& name, std::size_t page = 0) {
    return read_picture(k_files / name, page);
}

TEST(Tiff, GraysOfOtherProgramsAreRead) {
    for (const auto& [name, off] : std::map<std::string, int>{
             {"gray.tif", 0}, {"gray_big_endian.tif", 0}, {"gray16_big_endian.tif", 0}, {"gray_jpeg.tif", 40}}) {
        SCOPED_TRACE(name);
        const Image image = read_one(name);
        ASSERT_EQ(image.width, k_width);
        ASSERT_EQ(image.height, k_height);
        ASSERT_EQ(image.channels, 1);
        for (int y = 0; y < k_height; ++y)
            for (int x = 0; x < k_width; ++x) EXPECT_LE(std::abs(image.pixel(x, y)[0] - gray_at(x, y)), off);
    }
}

TEST(Tiff, ColorsOfOtherProgramsAreRead) {
    for (const auto& [name, channels] :
         std::map<std::string, int>{{"rgb_lzw.tif", 3}, {"rgba_deflate.tif", 4}, {"tiles.tif", 3}}) {
        SCOPED_TRACE(name);
        const Image image = read_one(name);
        ASSERT_EQ(image.width, k_width);
        ASSERT_EQ(image.height, k_height);
        ASSERT_EQ(image.channels, channels);
        for (int y = 0; y < k_height; ++y)
            for (int x = 0; x < k_width; ++x)
                for (std::size_t c = 0; c < static_cast<std::size_t>(channels); ++c)
                    EXPECT_EQ(image.pixel(x, y)[c], color_at(x, y)[c]) << x << ' ' << y;
    }
    EXPECT_EQ(read_one("palette.tif").channels, 3);
}

/// JPEG is coarse at so few pixels: the means of the channels tell whether its RGB was taken for YCbCr.
TEST(Tiff, RgbInJpegStaysRgb) {
    const Image image = read_one("rgb_jpeg.tif");
    ASSERT_EQ(image.channels, 3);
    std::array<double, 3> sum{}, expected{};
    for (int y = 0; y < k_height; ++y)
        for (int x = 0; x < k_width; ++x)
            for (std::size_t c = 0; c < 3; ++c) sum[c] += image.pixel(x, y)[c], expected[c] += color_at(x, y)[c];
    for (std::size_t c = 0; c < 3; ++c)
        EXPECT_NEAR(sum[c] / (k_width * k_height), expected[c] / (k_width * k_height), 4);
}

TEST(Tiff, LineArtOfScannersIsRead) {
    for (const char* name : {"group4.tif", "group4_reversed_bits.tif"}) {
        SCOPED_TRACE(name);
        const Image image = read_one(name);
        ASSERT_EQ(image.width, k_width);
        for (int y = 0; y < k_height; ++y)
            for (int x = 0; x < k_width; ++x) EXPECT_EQ(image.pixel(x, y)[0], (x + 2 * y) % 12 > 3 ? 255 : 0);
    }
}

TEST(Tiff, IsTurnedAsItSays) {
    const Image image = read_one("turned.tif");  // its first row is the right column
    ASSERT_EQ(image.width, k_height);
    ASSERT_EQ(image.height, k_width);
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) EXPECT_EQ(image.pixel(x, y)[0], gray_at(y, k_height - 1 - x));
}

TEST(Tiff, APageIsNamedIfThereAreSeveral) {
    const auto refused = [](std::size_t page, const char* says) {
        try {
            read_one("pages.tif", page);
            FAIL() << page;
        } catch (const DataError& error) {
            EXPECT_THAT(error.what(), HasSubstr(says));
        }
    };
    refused(0, "pages.tif: has 2 pages; say which with --page 1 to 2");
    refused(3, "pages.tif: has 2 pages, so there is no page 3");
    const Image first = read_one("pages.tif", 1), second = read_one("pages.tif", 2);
    for (int y = 0; y < k_height; ++y)
        for (int x = 0; x < k_width; ++x)
            EXPECT_EQ(first.pixel(x, y)[0], second.pixel(k_width - 1 - x, k_height - 1 - y)[0]);
    EXPECT_EQ(read_one("gray.tif", 1), read_one("gray.tif"));
    EXPECT_THROW(read_one("gray.tif", 2), DataError);
}

TEST(Tiff, WhatIsNotReadIsNamedWithAWayOut) {
    for (const auto& [name, says] :
         std::map<std::string, std::string>{{"refused_cmyk.tif", "a TIFF with the colors of a printing press (CMYK)"},
                                            {"refused_group3.tif", "a TIFF with CCITT Group 3 compression"},
                                            {"refused_float.tif", "a TIFF with 32 bits a sample"},
                                            {"refused_planes.tif", "channels one after the other (planes)"},
                                            {"refused_big.tif", "a TIFF with BigTIFF"},
                                            {"refused_circle.tif", "its pages are linked in a circle"}})
        try {
            read_one(name);
            FAIL() << name;
        } catch (const DataError& error) {
            EXPECT_THAT(error.what(), HasSubstr(name + ": "));
            EXPECT_THAT(error.what(), HasSubstr(says));
            EXPECT_THAT(error.what(), HasSubstr("export it as PNG"));
        }
}

TEST(Tiff, CutOffPixelsAreRefused) {
    const TemporaryFolder folder;
    const std::string content = read_file(k_files / "gray.tif");
    std::ofstream(folder / "half.tif", std::ios::binary) << content.substr(0, content.size() - 20);
    try {
        read_picture(folder / "half.tif");
        FAIL();
    } catch (const DataError& error) {
        EXPECT_THAT(error.what(), HasSubstr("half.tif: not a readable TIFF"));
    }
}

/// Encodes rows as Group 4 does, but with runs only, and changes right below each other.
TEST(Group4, RunsOfAllKindsAreRead) {
    // 40 white, 5 black, 3 white: horizontal, 40 white, 5 black; then the end of the row as above (vertical).
    const std::string bytes{"\x25\x27", 2};  // 001 00101001 0011 1
    std::vector<std::uint8_t> row(6);
    ASSERT_TRUE(unpack_group4(bytes, 48, row));
    EXPECT_EQ(row, (std::vector<std::uint8_t>{0, 0, 0, 0, 0, 0xf8}));
    EXPECT_FALSE(unpack_group4(bytes.substr(0, 1), 48, row));
    EXPECT_FALSE(unpack_group4(std::string("\0\0", 2), 48, row));
}

TEST(PackedBytes, TooFewBytesAreNoted) {
    std::vector<std::uint8_t> out(5);
    EXPECT_TRUE(unpack_bits(std::string("\x01"
                                        "ab\xfe"
                                        "c",
                                        5),
                            out));
    EXPECT_EQ(std::string(out.begin(), out.end()), "abccc");
    EXPECT_FALSE(
        unpack_bits("\x05"
                    "ab",
                    out));
    EXPECT_FALSE(unpack_bits("", out));
    EXPECT_FALSE(unpack_lzw(std::string("\x80\x40", 2), out));
    EXPECT_FALSE(unpack_deflate("no", out));
}

}  // namespace
}  // namespace exemplar
