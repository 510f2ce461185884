#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "host/hatching/fields/hatch_stroke.h"
#include "host/hatching/fields/hatching_fields.h"
#include "host/hatching/placement/streamlines.h"

namespace exemplar {

/// The most by which relaxing moves a point of a stroke, in spacings, and turns a stroke, in radians.
constexpr float k_most_relaxing = 0.3f, k_most_relaxing_turn = 0.06f;

/// Moves strokes sideways, and turns them a little, as wholes, so that gaps on both of their sides come nearer to the
/// target spacing: where directions spread or draw together, strokes that were placed one after the other leave narrow
/// gaps beside wide ones. Points stay where their layer has strokes. Beyond the thesis. Throws UsageError for a stroke
/// of no layer or a negative number of iterations.
void relax_spacing(std::span<HatchStroke> strokes, const HatchingFields& fields, int iterations = 6);

/// Places strokes, relaxes them, and places them again: what came too near to others is cut, and new strokes fill the
/// room that was won; twice. All arguments as for StrokePlacer::place.
std::vector<HatchStroke> place_evenly(StrokePlacer& placer, const HatchingFields& fields,
                                      std::span<const std::uint8_t> barriers, const StrokeOptions& options,
                                      std::span<const HatchStroke> kept = {});

}  // namespace exemplar
