#pragma once

#include <array>
#include <cstdint>

#include "host/imaging/image.h"
#include "host/mesh/mesh.h"

namespace exemplar {

/// 0 or 1 per pixel, one channel.
using PixelMask = BasicImage<std::uint8_t>;

using Pixel = std::array<int, 2>;
/// Where the middle of a pixel lies in the image.
inline Vec2 center_of(const Pixel& pixel) {
    return {static_cast<float>(pixel[0]) + 0.5f, static_cast<float>(pixel[1]) + 0.5f};
}

/// The pixels that strokes cover: those at least half as dark as the darkest within three pixels (so that edges lie at
/// half of the stroke's darkness, whatever it is), or on the crest of a fainter stroke that passes a darker one; but
/// not those in a valley between two strokes. Nothing fainter than `faintest` counts; `darkness` is to be smoothed a
/// little, as noise makes ragged edges.
PixelMask ink_pixels(const FloatImage& darkness, float faintest);

}  // namespace exemplar
