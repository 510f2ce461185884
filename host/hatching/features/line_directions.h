#pragma once

#include <span>
#include <vector>

#include "host/hatching/features/direction_smoothing.h"
#include "host/hatching/features/hatching_surface.h"
#include "host/lines/extraction/lines.h"

namespace exemplar {

/// How far a direction is to be trusted whose extent exceeds that across it by `gap` (a share of the larger, in [0,
/// 1]): not at all at 0, fully from 0.3 on.
inline float direction_confidence(float gap) {
    const float x = gap / 0.3f;
    return x >= 1 ? 1.0f : x > 0 ? x * x : 0.0f;
}

/// The surface as lines are found on it.
LineSurface line_surface(const HatchingSurface& surface);

/// Directions along lines on a surface, completed between them: V unit tangents, or zeros if there are no lines.
std::vector<Vec3> complete_lines(const DirectionSmoother& smoother, const HatchingSurface& surface,
                                 std::span<const LineSegment> segments);
/// The same of ridges or valleys.
std::vector<Vec3> complete_lines(const DirectionSmoother& smoother, const HatchingSurface& surface, LineType type);

}  // namespace exemplar
