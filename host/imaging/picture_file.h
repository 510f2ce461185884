#pragma once

#include <filesystem>
#include <string_view>

#include "host/imaging/image.h"

namespace exemplar {

/// Reads a PNG (see read_png) or a JPEG, which the content tells, not the name. A JPEG is returned upright, as its EXIF
/// orientation says, and as gray or RGB. Throws DataError, naming the file, if it cannot be read, is damaged, has more
/// than 2^28 pixels, or is of another kind (TIFF, PDF, SVG, HEIC, GIF, WebP, BMP are named, with a way out).
Image read_picture(const std::filesystem::path& path);

/// Decodes the content of a JPEG as above; `name` is for errors.
Image decode_jpeg(std::string_view content, const std::string& name);

}  // namespace exemplar
