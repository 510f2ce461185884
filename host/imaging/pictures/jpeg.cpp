#include "host/imaging/pictures/jpeg.h"

#include <fmt/format.h>
#include <turbojpeg.h>

#include <cstdint>
#include <memory>
#include <utility>

#include "host/core/errors.h"
#include "host/imaging/pictures/upright.h"

namespace exemplar {
namespace {

constexpr std::size_t k_max_jpeg_pixels = std::size_t{1} << 28;
constexpr std::string_view k_jpeg_start = "\xff\xd8\xff";

std::uint32_t byte_at(std::string_view bytes, std::size_t at) {
    return static_cast<std::uint8_t>(bytes[at]);
}

/// Returns the orientation in the EXIF data of a JPEG, 1 to 8; 1 (upright) if there is none.
std::uint32_t exif_orientation(std::string_view jpeg) {
    constexpr std::string_view k_exif{"Exif\0\0", 6};
    // Segments before the picture: a marker of two bytes, and a length that counts itself.
    for (std::size_t at = 2; at + 4 <= jpeg.size() && byte_at(jpeg, at) == 0xff;) {
        const std::size_t length = byte_at(jpeg, at + 2) << 8 | byte_at(jpeg, at + 3);
        if (length < 2 || at + 2 + length > jpeg.size() || byte_at(jpeg, at + 1) == 0xda) return 1;
        const std::string_view segment = jpeg.substr(at + 4, length - 2);
        at += 2 + length;
        if (!segment.starts_with(k_exif) || segment.size() < 6 + 14) continue;
        // A TIFF: byte order, where the first directory is, and in it entries of 12 bytes.
        const std::string_view tiff = segment.substr(6);
        const bool little = tiff.starts_with("II");
        const auto number = [&](std::size_t place, std::size_t bytes) {
            std::uint32_t value = 0;
            for (std::size_t i = 0; i < bytes && place + i < tiff.size(); ++i)
                value |= byte_at(tiff, place + i) << 8 * (little ? i : bytes - 1 - i);
            return value;
        };
        constexpr std::uint32_t k_orientation_tag = 0x112;
        const std::size_t directory = number(4, 4), entries = number(directory, 2);
        for (std::size_t i = 0; i < entries && directory + 2 + 12 * (i + 1) <= tiff.size(); ++i) {
            const std::size_t entry = directory + 2 + 12 * i;
            if (number(entry, 2) != k_orientation_tag) continue;
            const std::uint32_t value = number(entry + 8, 2);
            return value >= 1 && value <= 8 ? value : 1;
        }
    }
    return 1;
}

}  // namespace

bool is_jpeg(std::string_view content) {
    return content.starts_with(k_jpeg_start);
}

Image decode_jpeg(std::string_view content, const std::string& name) {
    const std::unique_ptr<void, int (*)(tjhandle)> handle(tjInitDecompress(), tjDestroy);
    // NOLINTNEXTLINE(cppcoreguidelines-pro-type-reinterpret-cast): TurboJPEG reads bytes
    const auto* bytes = reinterpret_cast<const unsigned char*>(content.data());
    const auto size = static_cast<unsigned long>(content.size());
    const auto fail = [&](const std::string& why) {
        throw DataError(fmt::format("{}: not a readable JPEG: {}", name, why));
    };
    int width = 0, height = 0, subsampling = 0, colors = 0;
    if (tjDecompressHeader3(handle.get(), bytes, size, &width, &height, &subsampling, &colors) != 0)
        fail(tjGetErrorStr2(handle.get()));
    if (colors == TJCS_CMYK || colors == TJCS_YCCK) fail("its colors are those of a printing press; save it as RGB");
    if (static_cast<std::size_t>(width) * static_cast<std::size_t>(height) > k_max_jpeg_pixels)
        fail("more than 2^28 pixels");
    const bool gray = colors == TJCS_GRAY;
    Image picture(width, height, gray ? 1 : 3);
    // A warning, as of a file that was cut off, is an error as well: what is missing would be gray.
    if (tjDecompress2(handle.get(), bytes, size, picture.data.data(), width, 0, height, gray ? TJPF_GRAY : TJPF_RGB,
                      TJFLAG_ACCURATEDCT) != 0)
        fail(tjGetErrorStr2(handle.get()));
    return upright(std::move(picture), exif_orientation(content));
}

}  // namespace exemplar
