#pragma once

#include <string>
#include <string_view>

#include "host/imaging/image.h"

namespace exemplar {

/// Returns whether bytes begin like a JPEG.
bool is_jpeg(std::string_view content);
/// Decodes the content of a JPEG to gray or RGB, upright as its EXIF orientation says; `name` is for errors. Throws
/// DataError if it is damaged, has more than 2^28 pixels, or is of other colors.
Image decode_jpeg(std::string_view content, const std::string& name);

}  // namespace exemplar
