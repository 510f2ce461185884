#pragma once

#include <array>
#include <cstdint>

#include "host/imaging/image.h"
#include "host/mesh/mesh.h"

namespace exemplar {

/// 0 or 1 per pixel, one channel.
using PixelMask = BasicImage<std::uint8_t>;

using Pixel = std::array<int, 2>;
/// Returns the center of a pixel in image coordinates.
inline Vec2 center_of(const Pixel& pixel) {
    return {static_cast<float>(pixel[0]) + 0.5f, static_cast<float>(pixel[1]) + 0.5f};
}

/// Finds the pixels that strokes cover. These are at least half as dark as the darkest pixel within three pixels, so
/// that edges lie at half of a stroke's darkness, whatever it is; or they lie on the crest of a fainter stroke
/// beside a darker one. Pixels in a valley between two strokes are left out, as are those fainter than `faintest`.
/// Smooth `darkness` a little first: noise makes edges ragged.
PixelMask ink_pixels(const FloatImage& darkness, float min_darkness);

}  // namespace exemplar
