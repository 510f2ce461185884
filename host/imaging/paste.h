#pragma once

#include "host/imaging/image.h"

namespace exemplar {

/// Puts `part` into an image with its upper left corner at pixel (left, top). Throws UsageError unless all of it is
/// inside and the channels are as many.
void paste(const Image& part, int left, int top, Image& image);

}  // namespace exemplar
