#include "host/imaging/paste.h"

#include <fmt/format.h>

#include <algorithm>

#include "host/core/errors.h"

namespace exemplar {

void paste(const Image& part, int left, int top, Image& image) {
    const bool inside = left >= 0 && top >= 0 && part.width <= image.width - left && part.height <= image.height - top;
    if (!inside || part.channels != image.channels)
        throw UsageError(fmt::format("{} x {} pixels of {} channels at ({}, {}) do not fit into {} x {} of {}",
                                     part.width, part.height, part.channels, left, top, image.width, image.height,
                                     image.channels));
    const std::size_t row = static_cast<std::size_t>(part.width) * static_cast<std::size_t>(part.channels);
    if (row == 0) return;
    for (int y = 0; y < part.height; ++y) std::copy_n(part.pixel(0, y).data(), row, image.pixel(left, top + y).data());
}

}  // namespace exemplar
