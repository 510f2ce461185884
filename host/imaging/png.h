#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "host/imaging/image.h"

namespace exemplar {

/// Writes a gray, RGB or RGBA image; readers never see half a file (write_file_atomically). The same image gives the
/// same bytes. Throws UsageError for another number of channels or an empty image, DataError if it cannot be written.
void write_png(const std::filesystem::path& path, const Image& image);

/// A text in a PNG, and its printed size. Other programs ignore the text.
struct PngText {
    std::string keyword;       ///< 1 to 79 characters of ASCII
    std::string text;          ///< ASCII
    double pixels_per_mm = 0;  ///< at which it is printed; 0: not said
};
/// Writes an image like write_png, with a text in it (a tEXt chunk).
void write_png(const std::filesystem::path& path, const Image& image, const PngText& text);
/// Returns the text with a keyword from the content of a PNG; none if it has no such text or its bytes are damaged.
std::optional<std::string> png_text(std::string_view content, std::string_view keyword);

/// Reads a PNG as gray, RGB or RGBA, whichever holds it without loss of color or alpha (gray with alpha becomes RGBA,
/// a palette RGB or RGBA); 16-bit files are rounded to 8 bits. Throws DataError, naming the file, if it cannot be read,
/// is damaged, or has more than 2^28 pixels.
Image read_png(const std::filesystem::path& path);

}  // namespace exemplar
