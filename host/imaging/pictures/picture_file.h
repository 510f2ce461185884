#pragma once

#include <cstddef>
#include <filesystem>

#include "host/imaging/image.h"

namespace exemplar {

/// Reads a PNG (read_png), a JPEG (decode_jpeg) or a TIFF (decode_tiff), which the content tells, not the name. `page`:
/// of a TIFF, from 1; 0: its only one. Throws DataError, naming the file, if it cannot be read, is damaged, has more
/// than 2^28 pixels, has several pages and none is named, has not that page, or is of another kind (PDF, SVG, HEIC,
/// GIF, WebP, BMP are named, with a way out).
Image read_picture(const std::filesystem::path& path, std::size_t page = 0);

}  // namespace exemplar
