#include "host/imaging/png.h"

#include <fmt/format.h>
#include <png.h>
#include <zlib.h>

#include <cmath>
#include <ostream>
#include <string>

#include "host/core/errors.h"
#include "host/core/files.h"

namespace exemplar {
namespace {

constexpr std::size_t k_max_pixels = std::size_t{1} << 28;

/// libpng's simplified reader and writer state, freed on every path.
struct PngState {
    png_image image{};
    PngState() { image.version = PNG_IMAGE_VERSION; }
    ~PngState() { png_image_free(&image); }
    PngState(const PngState&) = delete;
    PngState& operator=(const PngState&) = delete;
};

png_uint_32 format_of(int channels) {
    if (channels == 1) return PNG_FORMAT_GRAY;
    return channels == 3 ? PNG_FORMAT_RGB : PNG_FORMAT_RGBA;
}

int channels_of(png_uint_32 format) {
    if (format & PNG_FORMAT_FLAG_ALPHA) return 4;
    return format & PNG_FORMAT_FLAG_COLOR ? 3 : 1;
}

std::string encode(const std::filesystem::path& path, const Image& image) {
    PngState state;
    state.image.width = static_cast<png_uint_32>(image.width);
    state.image.height = static_cast<png_uint_32>(image.height);
    state.image.format = format_of(image.channels);
    png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(state.image);
    std::string bytes(size, '\0');
    if (!png_image_write_to_memory(&state.image, bytes.data(), &size, 0, image.data.data(), 0, nullptr))
        throw DataError(fmt::format("{}: cannot be encoded as PNG: {}", path.string(), state.image.message));
    bytes.resize(size);
    return bytes;
}

// The simplified interface of libpng knows no text. A file is a signature of 8 bytes and chunks: the length of their
// data, a type of four letters, the data, and a checksum of type and data; the first one is always IHDR.
constexpr std::size_t k_signature = 8, k_frame = 12;  // bytes: length, type and checksum around the data
constexpr std::size_t k_header_end = k_signature + k_frame + 13;

std::string big_endian(std::size_t value) {
    std::string bytes;
    for (const int shift : {24, 16, 8, 0}) bytes += static_cast<char>(value >> shift & 255);
    return bytes;
}

std::size_t big_endian_at(std::string_view bytes, std::size_t at) {
    std::size_t value = 0;
    for (std::size_t i = 0; i < 4; ++i) value = value << 8 | static_cast<std::uint8_t>(bytes[at + i]);
    return value;
}

std::size_t checksum(std::string_view bytes) {
    // NOLINTNEXTLINE(cppcoreguidelines-pro-type-reinterpret-cast): zlib reads bytes
    return crc32(0, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(bytes.size()));
}

/// Returns a chunk of a type and its data.
std::string png_chunk(const std::string& type_and_data) {
    return big_endian(type_and_data.size() - 4) + type_and_data + big_endian(checksum(type_and_data));
}

std::string chunks_of(const PngText& text) {
    std::string chunks = png_chunk("tEXt" + text.keyword + '\0' + text.text);
    if (text.pixels_per_mm <= 0) return chunks;
    const std::string per_meter = big_endian(static_cast<std::size_t>(std::lround(1000 * text.pixels_per_mm)));
    return chunks + png_chunk("pHYs" + per_meter + per_meter + '\1');
}

std::string checked_and_encoded(const std::filesystem::path& path, const Image& image) {
    if (image.channels != 1 && image.channels != 3 && image.channels != 4)
        throw UsageError(fmt::format("{}: a PNG takes 1, 3 or 4 channels, not {}", path.string(), image.channels));
    if (image.width <= 0 || image.height <= 0)
        throw UsageError(fmt::format("{}: the image is empty ({} x {})", path.string(), image.width, image.height));
    return encode(path, image);
}

}  // namespace

void write_png(const std::filesystem::path& path, const Image& image) {
    const std::string bytes = checked_and_encoded(path, image);
    write_file_atomically(path, [&](std::ostream& out) { out << bytes; });
}

void write_png(const std::filesystem::path& path, const Image& image, const PngText& text) {
    std::string bytes = checked_and_encoded(path, image);
    bytes.insert(k_header_end, chunks_of(text));
    write_file_atomically(path, [&](std::ostream& out) { out << bytes; });
}

std::optional<std::string> png_text(std::string_view content, std::string_view keyword) {
    for (std::size_t at = k_signature; at + k_frame <= content.size();) {
        const std::size_t length = big_endian_at(content, at);
        if (length > content.size() - at - k_frame) return std::nullopt;
        const std::string_view checked = content.substr(at + 4, length + 4), data = checked.substr(4);
        if (checked.starts_with("tEXt") && data.starts_with(keyword) && data.size() > keyword.size() &&
            data[keyword.size()] == '\0' && big_endian_at(content, at + 8 + length) == checksum(checked))
            return std::string(data.substr(keyword.size() + 1));
        at += k_frame + length;
    }
    return std::nullopt;
}

Image read_png(const std::filesystem::path& path) {
    const std::string bytes = read_file(path);
    PngState state;
    const auto fail = [&](const char* reason) {
        throw DataError(fmt::format("{}: not a readable PNG: {}", path.string(), reason));
    };
    if (!png_image_begin_read_from_memory(&state.image, bytes.data(), bytes.size())) fail(state.image.message);
    if (std::size_t{state.image.width} * state.image.height > k_max_pixels) fail("more than 2^28 pixels");

    const int channels = channels_of(state.image.format);
    state.image.format = format_of(channels);
    Image image(static_cast<int>(state.image.width), static_cast<int>(state.image.height), channels);
    const bool read = png_image_finish_read(&state.image, nullptr, image.data.data(), 0, nullptr) != 0;
    if (!read || PNG_IMAGE_FAILED(state.image)) fail(state.image.message);
    return image;
}

}  // namespace exemplar
