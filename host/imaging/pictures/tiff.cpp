#include "host/imaging/pictures/tiff.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>
#include <utility>
#include <vector>

#include "host/core/errors.h"
#include "host/imaging/pictures/group4.h"
#include "host/imaging/pictures/jpeg.h"
#include "host/imaging/pictures/packed_bytes.h"
#include "host/imaging/pictures/upright.h"

namespace exemplar {
namespace {

constexpr std::string_view k_jpeg_begin = "\xff\xd8", k_jpeg_end = "\xff\xd9";

/// Returns the most bytes that a byte of compressed data can become.
std::size_t largest_expansion(TiffCompression compression) {
    switch (compression) {
        case TiffCompression::packbits:
            return 64;
        case TiffCompression::lzw:
            return 2731;  // 4096 bytes for 12 bits
        case TiffCompression::deflate:
        case TiffCompression::old_deflate:
            return 1040;
        default:
            return 1;
    }
}

std::string with_bits_reversed(std::string_view bytes) {
    std::string out(bytes);
    for (char& each : out) {
        std::uint32_t reversed = 0;
        for (std::uint32_t bit = 0; bit < 8; ++bit)
            reversed |= (static_cast<std::uint8_t>(each) >> bit & 1U) << (7 - bit);
        each = static_cast<char>(reversed);
    }
    return out;
}

/// Joins the tables that all blocks share and the JPEG of a block. A marker of Adobe tells whether three colors are
/// RGB, which JPEG itself does not say.
std::string whole_jpeg(const TiffPage& page, std::string_view block) {
    std::string_view tables = page.jpeg_tables;
    if (tables.starts_with(k_jpeg_begin)) tables.remove_prefix(2);
    if (tables.ends_with(k_jpeg_end)) tables.remove_suffix(2);
    std::string out(k_jpeg_begin);
    if (page.samples == 3) {
        out += std::string_view(
            "\xff\xee\0\x0e"
            "Adobe\0\x64\0\0\0\0",
            15);
        out += page.colors == TiffColors::ycbcr ? '\1' : '\0';
    }
    return out.append(tables).append(block.substr(2));
}

/// Decodes a page's blocks, and puts their samples together.
class TiffDecoder {
  public:
    TiffDecoder(const TiffPage& page, const std::string& name) : page_(page), name_(name) { read_grays(); }

    Image image() {
        const bool alpha = page_.has_alpha();
        const bool colored = page_.color_samples() == 3 || page_.colors == TiffColors::palette;
        const int gray_channels = alpha ? 4 : 1;
        Image image(static_cast<int>(page_.width), static_cast<int>(page_.height),
                    colored ? (alpha ? 4 : 3) : gray_channels);
        for (std::uint32_t down = 0; down < page_.blocks_down(); ++down)
            for (std::uint32_t across = 0; across < page_.blocks_across(); ++across) place_block(across, down, image);
        return image;
    }

  private:
    /// Fills the table that takes a sample of up to 8 bits to its gray.
    void read_grays() {
        const std::uint32_t most = page_.bits < 8 ? (1U << page_.bits) - 1 : 255;
        const bool inverted = page_.colors == TiffColors::white_is_zero;
        for (std::uint32_t i = 0; i < grays_.size(); ++i) {
            const std::uint32_t gray = std::min(i, most) * 255 / most;
            grays_[i] = static_cast<std::uint8_t>(inverted ? 255 - gray : gray);
        }
    }

    void place_block(std::uint32_t across, std::uint32_t down, Image& image) {
        const std::uint32_t x0 = across * page_.block_width, y0 = down * page_.block_height;
        const std::uint32_t rows = std::min(page_.block_height, page_.height - y0);
        const std::uint32_t columns = std::min(page_.block_width, page_.width - x0);
        decode(page_.blocks[std::size_t{down} * page_.blocks_across() + across], rows, y0);
        for (std::uint32_t y = 0; y < rows; ++y) {
            const std::span<std::uint8_t> row = std::span(bytes_).subspan(page_.row_bytes() * y, page_.row_bytes());
            if (page_.differences) sum_differences(row);
            for (std::uint32_t x = 0; x < columns; ++x)
                place_pixel(row, x, image.pixel(static_cast<int>(x0 + x), static_cast<int>(y0 + y)));
        }
    }

    /// Decodes the first rows of a block; `row` is that of the page, for errors.
    void decode(std::string_view block, std::uint32_t rows, std::uint32_t row) {
        const std::size_t size = page_.row_bytes() * rows;
        const std::string reversed = page_.low_bit_first ? with_bits_reversed(block) : std::string();
        if (page_.low_bit_first) block = reversed;
        if (!fits(block.size(), rows, size)) damaged_at(row);
        bytes_.assign(size, 0);
        if (page_.compression == TiffCompression::jpeg)
            decode_jpeg_block(block, rows, row);
        else if (!unpack(block))
            damaged_at(row);
    }

    /// Returns whether so many compressed bytes can hold the rows; nothing is allocated before.
    bool fits(std::size_t block, std::uint32_t rows, std::size_t size) const {
        if (page_.compression == TiffCompression::jpeg) return block >= 2;  // which tells its own size
        if (page_.compression == TiffCompression::group4) return rows <= 8 * block;
        return size / largest_expansion(page_.compression) <= block;
    }

    bool unpack(std::string_view block) {
        switch (page_.compression) {
            case TiffCompression::none:
                if (block.size() < bytes_.size()) return false;
                std::copy_n(block.begin(), bytes_.size(), bytes_.begin());
                return true;
            case TiffCompression::packbits:
                return unpack_bits(block, bytes_);
            case TiffCompression::lzw:
                return unpack_lzw(block, bytes_);
            case TiffCompression::group4:
                return unpack_group4(block, page_.block_width, bytes_);
            default:
                return unpack_deflate(block, bytes_);
        }
    }

    void decode_jpeg_block(std::string_view block, std::uint32_t rows, std::uint32_t row) {
        if (!block.starts_with(k_jpeg_begin)) damaged_at(row);
        const Image image = decode_jpeg(whole_jpeg(page_, block), name_);
        if (image.width != static_cast<int>(page_.block_width) || image.height < static_cast<int>(rows) ||
            image.channels != static_cast<int>(page_.samples))
            throw_damaged_tiff(name_, fmt::format("the JPEG at row {} is of another size", row));
        std::copy_n(image.data.begin(), bytes_.size(), bytes_.begin());
    }

    /// Turns differences to the pixel at the left into samples.
    void sum_differences(std::span<std::uint8_t> row) const {
        if (page_.bits == 8) {
            for (std::size_t i = page_.samples; i < row.size(); ++i)
                row[i] = static_cast<std::uint8_t>(row[i] + row[i - page_.samples]);
            return;
        }
        const std::size_t high = page_.little_endian ? 1 : 0, step = std::size_t{2} * page_.samples;
        for (std::size_t i = step; i + 1 < row.size(); i += 2) {
            const auto at = [&](std::size_t place) { return row[place + high] << 8 | row[place + 1 - high]; };
            const int sum = at(i) + at(i - step);
            row[i + high] = static_cast<std::uint8_t>(sum >> 8 & 255);
            row[i + 1 - high] = static_cast<std::uint8_t>(sum & 255);
        }
    }

    /// Returns a sample of a row; of 16 bits the nearest of 8 bits.
    std::uint32_t sample(std::span<const std::uint8_t> row, std::size_t i) const {
        if (page_.bits == 8) return row[i];
        if (page_.bits == 16) {
            const std::uint32_t value =
                page_.little_endian ? row[2 * i] | row[2 * i + 1] << 8 : row[2 * i] << 8 | row[2 * i + 1];
            return (value * 255 + 32767) / 65535;
        }
        const std::size_t bit = i * page_.bits;
        return row[bit / 8] >> (8 - page_.bits - bit % 8) & ((1U << page_.bits) - 1);
    }

    void place_pixel(std::span<const std::uint8_t> row, std::size_t x, std::span<std::uint8_t> pixel) const {
        const std::size_t first = x * page_.samples, colors = page_.color_samples();
        for (std::size_t c = 0; c < std::min<std::size_t>(3, pixel.size()); ++c) {
            if (page_.colors == TiffColors::palette)
                pixel[c] = static_cast<std::uint8_t>(page_.palette[(c << page_.bits) + sample(row, first)] >> 8);
            else
                pixel[c] = gray(sample(row, first + std::min(c, colors - 1)));
        }
        if (pixel.size() == 4) place_alpha(static_cast<std::uint8_t>(sample_of_8_bits(row, first + colors)), pixel);
    }

    std::uint8_t gray(std::uint32_t value) const {
        return colors_are_rgb() && page_.bits >= 8 ? static_cast<std::uint8_t>(value) : grays_[value];
    }
    bool colors_are_rgb() const { return page_.color_samples() == 3; }

    std::uint32_t sample_of_8_bits(std::span<const std::uint8_t> row, std::size_t i) const {
        return page_.bits < 8 ? sample(row, i) * 255 / ((1U << page_.bits) - 1) : sample(row, i);
    }

    void place_alpha(std::uint8_t alpha, std::span<std::uint8_t> pixel) const {
        pixel[3] = alpha;
        if (page_.alpha != TiffAlpha::premultiplied || alpha == 0) return;
        for (std::size_t c = 0; c < 3; ++c)
            pixel[c] = static_cast<std::uint8_t>(std::min(255, (pixel[c] * 255 + alpha / 2) / alpha));
    }

    [[noreturn]] void damaged_at(std::uint32_t row) const {
        throw_damaged_tiff(name_, fmt::format("the pixels from row {} on are damaged or cut off", row));
    }

    const TiffPage& page_;
    const std::string& name_;
    std::array<std::uint8_t, 256> grays_{};
    std::vector<std::uint8_t> bytes_;  ///< of a block
};

}  // namespace

Image decode_tiff(const TiffPage& page, const std::string& name) {
    return upright(TiffDecoder(page, name).image(), page.orientation);
}

}  // namespace exemplar
