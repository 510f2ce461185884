#pragma once

#include <array>

#include "host/hatching/tracing/ink_mask.h"

namespace exemplar {

/// Offsets of a pixel's eight neighbors, in a circle: right, lower right, below, and so on.
constexpr std::array<std::array<int, 2>, 8> k_neighbor_offsets{
    {{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}}};
/// Returns which of a pixel's eight neighbors are set, in the order of k_neighbor_offsets; those outside of the image
/// are not.
std::array<bool, 8> ring_neighbors(const PixelMask& mask, int x, int y);

/// Thins a mask to lines one pixel wide with the same connectivity (Guo and Hall 1989), then removes the corners of
/// stairs, so that all pixels but those at ends and junctions have two of eight neighbors.
PixelMask thinned(PixelMask mask);
/// Removes the corners of stairs alone, for a skeleton that has lost some of its pixels.
void remove_stair_corners(PixelMask& skeleton);

}  // namespace exemplar
