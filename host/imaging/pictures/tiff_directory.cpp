#include "host/imaging/pictures/tiff_directory.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <set>
#include <utility>

#include "host/core/errors.h"

namespace exemplar {
namespace {

constexpr std::size_t k_max_tiff_pixels = std::size_t{1} << 28;
constexpr std::size_t k_max_block_bytes = std::size_t{1} << 30;
constexpr std::size_t k_max_tiff_pages = 10000;
constexpr std::size_t k_entry_bytes = 12;

enum class Tag : std::uint16_t {
    subfile = 254,
    width = 256,
    height = 257,
    bits = 258,
    compression = 259,
    colors = 262,
    fill_order = 266,
    strip_offsets = 273,
    orientation = 274,
    samples = 277,
    rows_per_strip = 278,
    strip_bytes = 279,
    planes = 284,
    predictor = 317,
    palette = 320,
    tile_width = 322,
    tile_height = 323,
    tile_offsets = 324,
    tile_bytes = 325,
    extra_samples = 338,
    sample_format = 339,
    jpeg_tables = 347
};

/// The directories of a TIFF: each is a count, entries of 12 bytes (tag, type, count, value or its place) and the place
/// of the next.
class TiffFile {
  public:
    TiffFile(std::string_view content, const std::string& name)
        : content_(content), name_(name), little_(content.starts_with("II")) {
        if (content.size() < 8) damaged("it ends before its first page");
        if (number(2, 2) == 43) throw_unread_tiff(name, "BigTIFF");
        if (number(2, 2) != 42) damaged("it does not begin like one");
    }

    bool little() const { return little_; }
    [[noreturn]] void damaged(const std::string& why) const { throw_damaged_tiff(name_, why); }
    [[noreturn]] void unread(const std::string& what) const { throw_unread_tiff(name_, what); }

    /// Returns where the directories of pages are. Thumbnails and masks are no pages.
    std::vector<std::size_t> pages() const {
        std::vector<std::size_t> found;
        std::set<std::size_t> seen;
        for (std::size_t at = number(4, 4); at != 0; at = number(end_of(at), 4)) {
            if (!seen.insert(at).second) damaged("its pages are linked in a circle");
            if (seen.size() > k_max_tiff_pages) damaged(fmt::format("more than {} pages", k_max_tiff_pages));
            constexpr std::uint32_t k_thumbnail = 1, k_mask = 4;
            if (!(value(at, Tag::subfile, 0) & (k_thumbnail | k_mask))) found.push_back(at);
        }
        return found;
    }

    /// Returns the numbers of an entry of a directory; none if it has no such entry.
    std::vector<std::uint32_t> values(std::size_t directory, Tag tag) const {
        const std::size_t entry = entry_of(directory, tag);
        if (entry == 0) return {};
        const std::size_t size = bytes_per_value(entry);
        const std::string_view bytes = data_of(entry, size);
        const auto start = static_cast<std::size_t>(bytes.data() - content_.data());
        std::vector<std::uint32_t> out;
        out.reserve(bytes.size() / size);
        for (std::size_t i = 0; i < bytes.size(); i += size) out.push_back(number(start + i, size));
        return out;
    }
    std::uint32_t value(std::size_t directory, Tag tag, std::uint32_t otherwise) const {
        const std::vector<std::uint32_t> all = values(directory, tag);
        return all.empty() ? otherwise : all.front();
    }
    /// Returns the bytes of an entry; empty if there is no such entry.
    std::string_view bytes(std::size_t directory, Tag tag) const {
        const std::size_t entry = entry_of(directory, tag);
        return entry == 0 ? std::string_view() : data_of(entry, bytes_per_value(entry));
    }
    /// Returns `size` bytes of the file.
    std::string_view range(std::size_t start, std::size_t size) const {
        if (start > content_.size() || size > content_.size() - start) damaged("it ends before its pixels do");
        return content_.substr(start, size);
    }

  private:
    std::uint32_t number(std::size_t at, std::size_t size) const {
        if (at > content_.size() || size > content_.size() - at) damaged("it ends in the middle of a page's entries");
        std::uint32_t out = 0;
        for (std::size_t i = 0; i < size; ++i)
            out |= std::uint32_t{static_cast<std::uint8_t>(content_[at + i])} << 8 * (little_ ? i : size - 1 - i);
        return out;
    }
    std::size_t end_of(std::size_t directory) const { return directory + 2 + k_entry_bytes * number(directory, 2); }
    /// Returns where the entry of a tag is; 0 if there is none.
    std::size_t entry_of(std::size_t directory, Tag tag) const {
        const std::size_t end = end_of(directory);
        for (std::size_t at = directory + 2; at < end; at += k_entry_bytes)
            if (number(at, 2) == static_cast<std::uint32_t>(tag)) return at;
        return 0;
    }
    std::size_t bytes_per_value(std::size_t entry) const {
        switch (number(entry + 2, 2)) {
            case 1:
            case 2:
            case 6:
            case 7:
                return 1;
            case 3:
                return 2;
            case 4:
                return 4;
            default:
                damaged(fmt::format("the numbers of tag {} are of a kind that it cannot have", number(entry, 2)));
        }
    }
    std::string_view data_of(std::size_t entry, std::size_t bytes_each) const {
        const std::size_t size = std::size_t{number(entry + 4, 4)} * bytes_each;
        return range(size <= 4 ? entry + 8 : number(entry + 8, 4), size);
    }

    std::string_view content_;
    const std::string& name_;
    bool little_;
};

constexpr std::array<std::uint32_t, 7> k_read_compressions{1, 4, 5, 7, 8, 32773, 32946};

std::string compression_name(std::uint32_t compression) {
    constexpr std::array<std::pair<std::uint32_t, const char*>, 8> k_names{{{2, "CCITT runs"},
                                                                            {3, "CCITT Group 3"},
                                                                            {6, "old JPEG"},
                                                                            {34661, "JBIG"},
                                                                            {34712, "JPEG 2000"},
                                                                            {34925, "LZMA"},
                                                                            {50000, "Zstandard"},
                                                                            {50001, "WebP"}}};
    for (const auto& [number, name] : k_names)
        if (number == compression) return fmt::format("{} compression", name);
    return fmt::format("compression {}", compression);
}

std::string colors_name(std::uint32_t colors) {
    if (colors == 5) return "the colors of a printing press (CMYK)";
    if (colors == 8 || colors == 9 || colors == 10) return "CIELab colors";
    return colors == 4 ? "a transparency mask alone" : fmt::format("colors of kind {}", colors);
}

void read_size(const TiffFile& file, std::size_t at, TiffPage& page) {
    page.width = file.value(at, Tag::width, 0);
    page.height = file.value(at, Tag::height, 0);
    if (page.width == 0 || page.height == 0) file.damaged("a page without pixels");
    if (page.height > k_max_tiff_pixels / page.width) file.damaged("more than 2^28 pixels");
    page.orientation = file.value(at, Tag::orientation, 1);
    if (page.orientation < 1 || page.orientation > 8) page.orientation = 1;
}

void read_samples(const TiffFile& file, std::size_t at, TiffPage& page) {
    page.samples = file.value(at, Tag::samples, 1);
    const std::vector<std::uint32_t> bits = file.values(at, Tag::bits);
    page.bits = bits.empty() ? 1 : bits.front();
    constexpr std::array<std::uint32_t, 5> k_bits{1, 2, 4, 8, 16};
    if (std::ranges::find(k_bits, page.bits) == k_bits.end()) file.unread(fmt::format("{} bits a sample", page.bits));
    if (std::ranges::any_of(bits, [&](std::uint32_t each) { return each != page.bits; }))
        file.unread("channels of different depth");
    const std::uint32_t format = file.value(at, Tag::sample_format, 1);
    if (format == 2 || format == 3) file.unread(format == 2 ? "signed samples" : "samples in floating point");
    page.little_endian = file.little();
}

void read_colors(const TiffFile& file, std::size_t at, TiffPage& page) {
    const std::uint32_t colors = file.value(at, Tag::colors, 0);
    if (colors > 3 && colors != 6) file.unread(colors_name(colors));
    page.colors = static_cast<TiffColors>(colors);
    const std::uint32_t needed = page.color_samples();
    if (page.samples < needed) file.damaged("fewer channels than its colors have");
    if (page.samples > needed + 1) file.unread(fmt::format("{} channels", page.samples));
    if (page.samples > 1 && file.value(at, Tag::planes, 1) != 1) file.unread("channels one after the other (planes)");
    if (page.samples > needed) {
        const std::uint32_t alpha = file.value(at, Tag::extra_samples, 0);
        if (alpha <= 2) page.alpha = static_cast<TiffAlpha>(alpha);
    }
    if (page.colors != TiffColors::palette) return;
    if (page.bits > 8) file.unread("a palette of 2^16 colors");
    for (const std::uint32_t value : file.values(at, Tag::palette))
        page.palette.push_back(static_cast<std::uint16_t>(value));
    if (page.palette.size() < std::size_t{3} << page.bits) file.damaged("its palette has too few colors");
}

void read_compression(const TiffFile& file, std::size_t at, TiffPage& page) {
    const std::uint32_t compression = file.value(at, Tag::compression, 1);
    if (std::ranges::find(k_read_compressions, compression) == k_read_compressions.end())
        file.unread(compression_name(compression));
    page.compression = static_cast<TiffCompression>(compression);
    const bool is_jpeg = page.compression == TiffCompression::jpeg;
    if (page.colors == TiffColors::ycbcr && !is_jpeg) file.unread("YCbCr colors outside of JPEG");
    if (is_jpeg && (page.bits != 8 || page.colors == TiffColors::palette || page.samples != page.color_samples()))
        file.unread("a JPEG of other than gray or three colors in 8 bits");
    if (is_jpeg) page.jpeg_tables = file.bytes(at, Tag::jpeg_tables);
    if (page.compression == TiffCompression::group4 && (page.bits != 1 || page.samples != 1))
        file.damaged("CCITT Group 4 compression of other than black and white");
    page.low_bit_first = file.value(at, Tag::fill_order, 1) == 2 && !is_jpeg;
    const std::uint32_t predictor = file.value(at, Tag::predictor, 1);
    const bool predicted = page.compression == TiffCompression::lzw || page.compression == TiffCompression::deflate ||
                           page.compression == TiffCompression::old_deflate;
    if (!predicted || predictor == 1) return;
    if (predictor != 2 || page.bits < 8) file.unread(fmt::format("predictor {} at {} bits", predictor, page.bits));
    page.differences = true;
}

void read_block_size(const TiffFile& file, std::size_t at, bool tiled, TiffPage& page) {
    page.block_width = tiled ? file.value(at, Tag::tile_width, 0) : page.width;
    page.block_height =
        tiled ? file.value(at, Tag::tile_height, 0)
              : std::min(page.height, file.value(at, Tag::rows_per_strip, std::numeric_limits<std::uint32_t>::max()));
    if (page.block_width == 0 || page.block_height == 0) file.damaged("strips or tiles without pixels");
    if (page.row_bytes() > k_max_block_bytes / std::min(page.block_height, page.height))
        file.damaged("tiles of more than 2^30 bytes");
}

void read_blocks(const TiffFile& file, std::size_t at, TiffPage& page) {
    const bool tiled = !file.values(at, Tag::tile_width).empty();
    read_block_size(file, at, tiled, page);
    const std::vector<std::uint32_t> offsets = file.values(at, tiled ? Tag::tile_offsets : Tag::strip_offsets);
    const std::vector<std::uint32_t> sizes = file.values(at, tiled ? Tag::tile_bytes : Tag::strip_bytes);
    const std::size_t count = std::size_t{page.blocks_across()} * page.blocks_down();
    if (offsets.size() < count || sizes.size() < count) file.damaged("fewer strips or tiles than its size needs");
    page.blocks.reserve(count);
    for (std::size_t i = 0; i < count; ++i) page.blocks.push_back(file.range(offsets[i], sizes[i]));
}

}  // namespace

void throw_damaged_tiff(const std::string& name, const std::string& why) {
    throw DataError(fmt::format("{}: not a readable TIFF: {}; export it as PNG", name, why));
}

void throw_unread_tiff(const std::string& name, const std::string& what) {
    throw DataError(fmt::format("{}: a TIFF with {} is not read; export it as PNG", name, what));
}

bool is_tiff(std::string_view content) {
    constexpr std::array<std::string_view, 4> k_starts{std::string_view("II*\0", 4), std::string_view("MM\0*", 4),
                                                       std::string_view("II+\0", 4), std::string_view("MM\0+", 4)};
    return std::ranges::any_of(k_starts, [&](std::string_view start) { return content.starts_with(start); });
}

std::size_t tiff_page_count(std::string_view content, const std::string& name) {
    return TiffFile(content, name).pages().size();
}

TiffPage read_tiff_page(std::string_view content, std::size_t page, const std::string& name) {
    const TiffFile file(content, name);
    const std::vector<std::size_t> pages = file.pages();
    if (page >= pages.size()) file.damaged("it has no such page");
    TiffPage out;
    read_size(file, pages[page], out);
    read_samples(file, pages[page], out);
    read_colors(file, pages[page], out);
    read_compression(file, pages[page], out);
    read_blocks(file, pages[page], out);
    return out;
}

}  // namespace exemplar
