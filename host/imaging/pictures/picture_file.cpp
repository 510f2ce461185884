#include "host/imaging/pictures/picture_file.h"

#include <fmt/format.h>

#include <array>
#include <string>
#include <utility>

#include "host/core/errors.h"
#include "host/core/files.h"
#include "host/core/text.h"
#include "host/imaging/pictures/jpeg.h"
#include "host/imaging/pictures/tiff.h"
#include "host/imaging/png.h"

namespace exemplar {
namespace {

/// Names a kind of picture that is not read, by how its content begins; empty if it is none of these.
std::string other_kind(std::string_view content) {
    constexpr std::array<std::pair<std::string_view, const char*>, 6> k_kinds{{{"%PDF", "a PDF"},
                                                                               {"GIF8", "a GIF"},
                                                                               {"BM", "a BMP"},
                                                                               {"<svg", "an SVG"},
                                                                               {"<?xml", "an SVG"},
                                                                               {"RIFF", "a WebP"}}};
    for (const auto& [start, kind] : k_kinds)
        if (content.starts_with(start)) return kind;
    if (content.size() > 12 && content.substr(4, 4) == "ftyp") return "a HEIC picture";
    return {};
}

/// Returns the page of a TIFF that is meant; 0: the only one.
Image read_page(std::string_view content, std::size_t page, const std::string& name) {
    const std::size_t count = tiff_page_count(content, name);
    if (page == 0 && count > 1)
        throw DataError(
            fmt::format("{}: has {} pages; say which with --page 1 to {}, or save one alone", name, count, count));
    if (page > count)
        throw DataError(fmt::format("{}: has {}, so there is no page {}", name, counted(count, "page"), page));
    return decode_tiff(read_tiff_page(content, page == 0 ? 0 : page - 1, name), name);
}

}  // namespace

Image read_picture(const std::filesystem::path& path, std::size_t page) {
    const std::string content = read_file(path), name = path.string();
    if (is_tiff(content)) return read_page(content, page, name);
    if (page > 1) throw DataError(fmt::format("{}: has 1 page, so there is no page {}", name, page));
    if (is_jpeg(content)) return decode_jpeg(content, name);
    if (const std::string kind = other_kind(content); !kind.empty())
        throw DataError(fmt::format("{}: {} is not read; save it as PNG, JPEG or TIFF", name, kind));
    return read_png(path);
}

}  // namespace exemplar
