#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "host/hatching/measurement/stroke_map.h"
#include "host/hatching/tracing/ink_mask.h"
#include "host/hatching/tracing/traced_strokes.h"

namespace exemplar {

/// Returns the crossings that corner detectors (Harris and Stephens 1988) confirm in the drawing and in its
/// skeleton: corners alone occur at the ends of strokes, too, and twice at crossings of small angles. Crossings
/// nearer to each other than strokes are thick there are merged to their centroid.
std::vector<Vec2> confirmed_intersections(std::span<const StrokeCrossing> crossings, const FloatImage& darkness,
                                          const PixelMask& skeleton, std::span<const TracedStroke> strokes);

/// Returns the hatching level per pixel of `mask`, zero outside of it. Hatched regions end half a spacing beyond the
/// last stroke. In a cross-hatched region two families of strokes overlap, with more than `max_single_intersections`
/// intersections, one of them within two of `usual_spacing` everywhere. Regions smaller than four squares of
/// `usual_spacing` take the level around them.
std::vector<std::uint8_t> hatching_levels(std::span<const TracedStroke> strokes, std::span<const Vec2> intersections,
                                          const PixelMask& mask, std::size_t max_single_intersections,
                                          float usual_spacing);

/// Returns 1 for pixels of `mask` beside one of the mask with another level. The object's outline is no boundary:
/// everything ends there.
std::vector<std::uint8_t> level_boundaries(std::span<const std::uint8_t> level, const PixelMask& mask);

}  // namespace exemplar
