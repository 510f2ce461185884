#pragma once

#include <array>

#include "host/hatching/tracing/ink_mask.h"

namespace exemplar {

/// Steps to the eight neighbors of a pixel in a circle: right, lower right, below, and so on.
constexpr std::array<std::array<int, 2>, 8> k_ring{
    {{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}}};
/// Which of the eight neighbors of a pixel are set, in the order of k_ring; none is outside of the image.
std::array<bool, 8> ring_around(const PixelMask& mask, int x, int y);

/// Thins a mask to lines one pixel wide that are connected as the mask is (Guo and Hall 1989), then takes the corners
/// out of stairs, so that all pixels but those at ends and junctions have two neighbors of eight.
PixelMask thinned(PixelMask mask);
/// The second half of that by itself, for a skeleton that lost some of its pixels.
void take_out_corners(PixelMask& skeleton);

}  // namespace exemplar
