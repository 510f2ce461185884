#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "host/hatching/tracing/ink_mask.h"
#include "host/hatching/measurement/stroke_map.h"
#include "host/hatching/tracing/traced_strokes.h"

namespace exemplar {

/// The crossings that corner detectors (Harris and Stephens 1988) confirm in the drawing and in its skeleton, those
/// nearer to each other than strokes are thick there merged to their centroid.
std::vector<Vec2> confirmed_intersections(std::span<const StrokeCrossing> crossings, const FloatImage& darkness,
                                          const PixelMask& skeleton, std::span<const TracedStroke> strokes);

/// Hatching level per pixel of `mask`, zero outside of it (see measure_strokes). A region of cross-hatching has more
/// than `most_of_single` intersections, everywhere within two of `usual_spacing`; regions of less than four of its
/// squares go to what is around them.
std::vector<std::uint8_t> hatching_levels(std::span<const TracedStroke> strokes, std::span<const Vec2> intersections,
                                          const PixelMask& mask, std::size_t most_of_single, float usual_spacing);

/// 1 for pixels of `mask` beside one of another level in the mask.
std::vector<std::uint8_t> level_boundaries(std::span<const std::uint8_t> level, const PixelMask& mask);

}  // namespace exemplar
