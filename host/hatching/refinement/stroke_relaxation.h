#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "host/hatching/fields/hatch_stroke.h"
#include "host/hatching/fields/hatching_fields.h"
#include "host/hatching/placement/streamlines.h"

namespace exemplar {

/// Limits of relaxation: offset of a stroke in spacings, and its rotation in radians.
constexpr float k_max_relaxation_offset = 0.3f, k_max_relaxation_rotation = 0.06f;

/// Moves whole strokes sideways and rotates them a little, so that the gaps on both of their sides approach the
/// target spacing: where directions diverge or converge, strokes placed one after the other leave narrow gaps beside
/// wide ones. A stroke stays where it is if one of its points would leave the hatched area of its layer. Beyond the
/// thesis. Throws UsageError for a stroke whose layer does not exist or a negative number of iterations.
void relax_spacing(std::span<HatchStroke> strokes, const HatchingFields& fields, int iterations = 6);

/// Places strokes; then, twice, relaxes them and places again with the result as `kept`: what is too near to others
/// is clipped, and new strokes fill the free space. Arguments as for StrokePlacer::place.
std::vector<HatchStroke> place_evenly(StrokePlacer& placer, const HatchingFields& fields,
                                      std::span<const std::uint8_t> barriers, const StrokeOptions& options,
                                      std::span<const HatchStroke> kept = {});

}  // namespace exemplar
