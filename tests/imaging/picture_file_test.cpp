#include "host/imaging/pictures/picture_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <turbojpeg.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <string>

#include "host/core/errors.h"
#include "host/imaging/pictures/jpeg.h"
#include "host/imaging/png.h"
#include "tests/support/temporary_folder.h"

namespace exemplar {
namespace {

using testing::HasSubstr;

/// A picture whose four quarters differ: black, dark, light, white in the order of reading.
Image quarters(int channels) {
    Image image(48, 32, channels);
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            std::ranges::fill(image.pixel(x, y), static_cast<std::uint8_t>(85 * (x >= 24) + 170 * (y >= 16)));
    return image;
}

std::string jpeg_of(const Image& image) {
    const std::unique_ptr<void, int (*)(tjhandle)> handle(tjInitCompress(), tjDestroy);
    unsigned char* bytes = nullptr;
    unsigned long size = 0;
    const bool gray = image.channels == 1;
    tjCompress2(handle.get(), image.data.data(), image.width, 0, image.height, gray ? TJPF_GRAY : TJPF_RGB, &bytes,
                &size, gray ? TJSAMP_GRAY : TJSAMP_444, 95, 0);
    std::string content(bytes, bytes + size);
    tjFree(bytes);
    return content;
}

/// Inserts EXIF data that tell an orientation.
std::string with_orientation(const std::string& jpeg, int orientation, bool little) {
    const std::string tiff = little ? std::string("II*\0\x08\0\0\0\x01\0\x12\x01\x03\0\x01\0\0\0", 18) +
                                          static_cast<char>(orientation) + std::string(7, '\0')
                                    : std::string("MM\0*\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01\0", 19) +
                                          static_cast<char>(orientation) + std::string(6, '\0');
    const std::string data = std::string("Exif\0\0", 6) + tiff;
    const std::size_t length = data.size() + 2;
    return jpeg.substr(0, 2) + "\xff\xe1" + static_cast<char>(length >> 8) + static_cast<char>(length & 255) + data +
           jpeg.substr(2);
}

/// The gray in the middle of each quarter.
std::array<int, 4> seen(const Image& image) {
    const int w = image.width, h = image.height;
    return {image.pixel(w / 4, h / 4)[0], image.pixel(3 * w / 4, h / 4)[0], image.pixel(w / 4, 3 * h / 4)[0],
            image.pixel(3 * w / 4, 3 * h / 4)[0]};
}

void expect_seen(const Image& image, const std::array<int, 4>& expected) {
    const std::array<int, 4> found = seen(image);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_LE(std::abs(found[i] - expected[i]), 4) << "quarter " << i;
}

TEST(Jpeg, IsReadInGrayAndColor) {
    for (const int channels : {1, 3}) {
        const Image image = decode_jpeg(jpeg_of(quarters(channels)), "x");
        EXPECT_EQ(image.channels, channels);
        EXPECT_EQ(image.width, 48);
        EXPECT_EQ(image.height, 32);
        expect_seen(image, {0, 85, 170, 255});
    }
}

TEST(Jpeg, IsTurnedAsExifSays) {
    const std::string jpeg = jpeg_of(quarters(3));
    // What is at the left and at the top of the file comes where, in each orientation (EXIF 2.3, tag 274).
    const std::array<std::array<int, 4>, 8> expected{{{0, 85, 170, 255},
                                                      {85, 0, 255, 170},
                                                      {255, 170, 85, 0},
                                                      {170, 255, 0, 85},
                                                      {0, 170, 85, 255},
                                                      {170, 0, 255, 85},
                                                      {255, 85, 170, 0},
                                                      {85, 255, 0, 170}}};
    for (int orientation = 1; orientation <= 8; ++orientation)
        for (const bool little : {false, true}) {
            SCOPED_TRACE(orientation);
            const Image image = decode_jpeg(with_orientation(jpeg, orientation, little), "x");
            EXPECT_EQ(image.width, orientation >= 5 ? 32 : 48);
            expect_seen(image, expected[static_cast<std::size_t>(orientation - 1)]);
        }
    expect_seen(decode_jpeg(with_orientation(jpeg, 9, true), "x"), {0, 85, 170, 255});
}

TEST(Jpeg, DamagedOnesAreRefusedByName) {
    const std::string jpeg = jpeg_of(quarters(3));
    for (const std::size_t size : {3U, 20U, 200U}) try {
            decode_jpeg(jpeg.substr(0, size), "half.jpg");
            FAIL() << size;
        } catch (const DataError& error) {
            EXPECT_THAT(error.what(), HasSubstr("half.jpg: not a readable JPEG"));
        }
}

TEST(PictureFile, IsToldByItsContent) {
    const TemporaryFolder folder;
    const auto write = [&](const char* name, const std::string& content) {
        std::ofstream(folder / name, std::ios::binary) << content;
        return folder / name;
    };
    expect_seen(read_picture(write("a.png", jpeg_of(quarters(1)))), {0, 85, 170, 255});
    write_png(folder / "b.jpg", quarters(3));
    EXPECT_EQ(read_picture(folder / "b.jpg"), quarters(3));
    for (const auto& [content, kind] :
         {std::pair{std::string("%PDF-1.4"), "a PDF is not read; save it as PNG, JPEG or TIFF"},
          std::pair{std::string("\0\0\0\x18"
                                "ftypheic....",
                                16),
                    "a HEIC picture"}})
        try {
            read_picture(write("other", content));
            FAIL() << kind;
        } catch (const DataError& error) {
            EXPECT_THAT(error.what(), HasSubstr(kind));
        }
}

}  // namespace
}  // namespace exemplar
