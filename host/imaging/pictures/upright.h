#pragma once

#include <cstdint>

#include "host/imaging/image.h"

namespace exemplar {

/// Turns or mirrors a picture as its orientation says (tag 274 of EXIF and TIFF): 1, upright, to 8.
Image upright(Image picture, std::uint32_t orientation);

}  // namespace exemplar
