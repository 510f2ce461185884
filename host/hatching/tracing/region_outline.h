#pragma once

#include <vector>

#include "host/hatching/tracing/ink_mask.h"
#include "host/imaging/image.h"
#include "host/mesh/mesh.h"

namespace exemplar {

/// The region grown by a disc of `radius` pixels and shrunk again: gaps up to twice as wide are closed.
PixelMask closed_region(const PixelMask& region, float radius);
/// The region with what it surrounds.
PixelMask without_holes(PixelMask region);
/// The region without connected pieces smaller than a share of its largest.
PixelMask without_small_pieces(const PixelMask& region, float share);

/// Signed distance to the border of a region at the centers of pixels, negative inside, in pixels. The border runs
/// between the pixels of the region and the others; an image that is all or nothing has distances beyond its size.
FloatImage signed_distance(const PixelMask& region);

/// Centers of the pixels of a region beside others, in rows from the top left, at most `most` of them evenly.
std::vector<Vec2> border_points(const PixelMask& region, std::size_t most);

/// Linear interpolation between the pixels of an image; beyond its border the outermost one's, plus the distance to it.
float distance_at(const FloatImage& distance, const Vec2& place);

}  // namespace exemplar
