#pragma once

#include <vector>

#include "host/hatching/tracing/ink_mask.h"
#include "host/imaging/image.h"
#include "host/mesh/mesh.h"

namespace exemplar {

/// Returns the region closed by a disc of `radius` pixels (dilated, then eroded): closes gaps up to twice as wide.
PixelMask closed_region(const PixelMask& region, float radius);
/// Returns the region with its holes filled.
PixelMask without_holes(PixelMask region);
/// Returns the region without connected components smaller than `share` of the largest.
PixelMask without_small_pieces(const PixelMask& region, float share);

/// Returns the signed distance, in pixels, from each pixel's center to the border of a region, negative inside. The
/// border runs between the pixels of the region and the others. If the region is empty or the whole image, distances
/// exceed the image's size.
FloatImage signed_distance(const PixelMask& region);

/// Returns the centers of a region's pixels beside pixels outside, in rows from the top left; at most `most` of
/// them, evenly selected.
std::vector<Vec2> border_points(const PixelMask& region, std::size_t most);

/// Interpolates a distance image linearly. Beyond its border, returns the outermost value plus the distance to it.
float distance_at(const FloatImage& distance, const Vec2& place);

/// Returns how much the distance changes along x and along y, from `step` pixels before a place to `step` behind it: a
/// vector that points out of the region.
Vec2 distance_change(const FloatImage& distance, const Vec2& place, float step);

}  // namespace exemplar
