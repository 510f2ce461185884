#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace exemplar {

/// Bits of a pixel's borders that no stroke may cross: to its right neighbor, and to the one below.
constexpr std::uint8_t k_barrier_right = 1, k_barrier_below = 2;

/// Finds the occlusion boundaries, at which strokes end (thesis Sec. 4.3), from depth along the camera's axis
/// (GBuffer::depth); returns the bits above per pixel. Depth jumps between two pixels if it changes by more than
/// 1/200 of the range of depths plus twice the largest change of the same sign from either to the pixel beyond it.
/// So steep planes, creases and surfaces that bend towards a contour are no jumps. A barrier always separates a
/// surface from the background (infinity); there is none within the background. Throws UsageError if sizes do not
/// fit.
std::vector<std::uint8_t> occlusion_barriers(std::span<const float> depth, int width, int height);

}  // namespace exemplar
