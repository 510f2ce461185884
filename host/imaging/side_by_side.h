#pragma once

#include <span>

#include "host/imaging/image.h"

namespace exemplar {

/// Images of the same height and channels from left to right as one. Throws UsageError if they are not, or there is
/// none.
Image side_by_side(std::span<const Image> images);

}  // namespace exemplar
