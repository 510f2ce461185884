#pragma once

#include <span>

#include "host/imaging/image.h"

namespace exemplar {

/// Joins images of the same height and channels from left to right. Throws UsageError if they differ or there is
/// none.
Image side_by_side(std::span<const Image> images);

}  // namespace exemplar
