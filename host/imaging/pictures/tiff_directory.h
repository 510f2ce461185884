#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace exemplar {

/// The value of the tag Compression.
enum class TiffCompression : std::uint16_t {
    none = 1,
    group4 = 4,
    lzw = 5,
    jpeg = 7,
    deflate = 8,
    packbits = 32773,
    old_deflate = 32946  ///< the same bytes as deflate
};

/// The value of the tag PhotometricInterpretation.
enum class TiffColors : std::uint16_t { white_is_zero = 0, black_is_zero = 1, rgb = 2, palette = 3, ycbcr = 6 };

/// The kind of a channel that follows the colors: transparency (premultiplied or straight), or something else.
enum class TiffAlpha : std::uint16_t { other = 0, premultiplied = 1, straight = 2 };

/// A page of a TIFF, as its directory tells; everything is checked against the file but for the compressed bytes.
struct TiffPage {
    std::uint32_t width = 0, height = 0;  ///< pixels, at most 2^28 together
    std::uint32_t bits = 1;               ///< per sample: 1, 2, 4, 8 or 16
    std::uint32_t samples = 1;            ///< per pixel: 1 to 4
    TiffCompression compression = TiffCompression::none;
    TiffColors colors = TiffColors::white_is_zero;
    TiffAlpha alpha = TiffAlpha::other;  ///< of the last sample, if there is one more than the colors have
    std::uint32_t orientation = 1;       ///< as in EXIF: 1 to 8; 1 is upright
    bool differences = false;            ///< rows hold differences between neighboring pixels (Predictor 2)
    bool low_bit_first = false;          ///< the bits of the blocks' bytes are in reverse order (FillOrder 2)
    bool little_endian = true;           ///< order of bytes in samples of 16 bits
    std::uint32_t block_width = 0, block_height = 0;  ///< pixels of strips (as wide as the page) or of tiles
    std::vector<std::string_view> blocks;             ///< compressed bytes, row by row; of the content that was read
    std::vector<std::uint16_t> palette;               ///< all reds, all greens, all blues, 2^bits each
    std::string_view jpeg_tables;

    std::uint32_t blocks_across() const { return (width - 1) / block_width + 1; }
    std::uint32_t blocks_down() const { return (height - 1) / block_height + 1; }
    /// Returns the bytes of a decoded row of a block.
    std::size_t row_bytes() const { return (std::size_t{block_width} * samples * bits + 7) / 8; }
    std::uint32_t color_samples() const { return colors == TiffColors::rgb || colors == TiffColors::ycbcr ? 3 : 1; }
    bool has_alpha() const { return samples > color_samples() && alpha != TiffAlpha::other; }
};

/// Returns whether bytes begin like a TIFF.
bool is_tiff(std::string_view content);
/// Returns how many pages a TIFF has, without thumbnails and masks. Throws DataError, naming the file, if its
/// directories are damaged, or if it is of a kind that is not read (BigTIFF).
std::size_t tiff_page_count(std::string_view content, const std::string& name);
/// Reads the directory of a page; the first is 0. Throws DataError, naming the file, what it has and the way out, if it
/// is damaged or not among what TiffPage can tell.
TiffPage read_tiff_page(std::string_view content, std::size_t page, const std::string& name);

/// Returns the error of a file with damaged bytes.
[[noreturn]] void throw_damaged_tiff(const std::string& name, const std::string& why);
/// Returns the error of a file with something that is not read.
[[noreturn]] void throw_unread_tiff(const std::string& name, const std::string& what);

}  // namespace exemplar
