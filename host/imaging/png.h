#pragma once

#include <filesystem>

#include "host/imaging/image.h"

namespace exemplar {

/// Writes a gray, RGB or RGBA image; readers never see half a file (write_file_atomically). The same image gives the
/// same bytes. Throws UsageError for another number of channels or an empty image, DataError if it cannot be written.
void write_png(const std::filesystem::path& path, const Image& image);

/// Reads a PNG as gray, RGB or RGBA, whichever holds it without loss of color or alpha (gray with alpha becomes RGBA,
/// a palette RGB or RGBA); 16-bit files are rounded to 8 bits. Throws DataError, naming the file, if it cannot be read,
/// is damaged, or has more than 2^28 pixels.
Image read_png(const std::filesystem::path& path);

}  // namespace exemplar
