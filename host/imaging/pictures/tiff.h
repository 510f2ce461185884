#pragma once

#include <string>

#include "host/imaging/image.h"
#include "host/imaging/pictures/tiff_directory.h"

namespace exemplar {

/// Decodes a page of a TIFF (read_tiff_page), whose content must still be there, upright, to gray, RGB or RGBA; samples
/// of 16 bits are rounded to 8. `name` is for errors.
/// Read are bilevel, gray, palette and RGB pictures of 1 to 16 bits, with or without alpha, in strips or tiles, of
/// either byte order; uncompressed, or compressed by PackBits, LZW, Deflate, CCITT Group 4 or JPEG. Throws DataError
/// for others, for damaged files, and for more than 2^28 pixels.
Image decode_tiff(const TiffPage& page, const std::string& name);

}  // namespace exemplar
