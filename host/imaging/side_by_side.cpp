#include "host/imaging/side_by_side.h"

#include <algorithm>

#include "host/core/errors.h"

namespace exemplar {

Image side_by_side(std::span<const Image> images) {
    if (images.empty()) throw UsageError("no images to put side by side; give one at least");
    int width = 0;
    for (const Image& image : images) {
        if (image.height != images[0].height || image.channels != images[0].channels)
            throw UsageError("images of different heights or channels cannot be put side by side; make them alike");
        width += image.width;
    }
    Image result(width, images[0].height, images[0].channels);
    auto out = result.data.begin();
    for (int y = 0; y < result.height; ++y)
        for (const Image& image : images) {
            const auto row = static_cast<std::ptrdiff_t>(image.width) * image.channels;
            out = std::copy_n(image.data.begin() + y * row, row, out);
        }
    return result;
}

}  // namespace exemplar
