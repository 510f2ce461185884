#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace exemplar {

/// What no stroke may step over: the border of a pixel to its right neighbor, and to the one below.
constexpr std::uint8_t k_barrier_right = 1, k_barrier_below = 2;

/// Occlusion boundaries, which strokes end at (thesis Sec. 4.3), from depth along the camera's axis (GBuffer::depth):
/// per pixel the bits above. Between neighbors depth jumps where the slope beside them does not explain their
/// difference: it is over twice the difference to the next pixel beyond either, counted only where depth changes the
/// same way there, plus 1/200 of the range of depths. So neither a steep plane, nor a crease, nor the bend of a contour
/// is a jump. Between something and nothing (infinity) there is always one, within nothing none. Throws UsageError if
/// sizes do not fit.
std::vector<std::uint8_t> occlusion_barriers(std::span<const float> depth, int width, int height);

}  // namespace exemplar
