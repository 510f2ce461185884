#pragma once

#include <span>
#include <vector>

#include "host/hatching/features/direction_smoothing.h"
#include "host/hatching/features/hatching_surface.h"
#include "host/lines/extraction/lines.h"

namespace exemplar {

/// Returns the confidence, in [0, 1], of a direction whose extent exceeds that across it by `gap` (a share of the
/// larger, in [0, 1]): 0 at a gap of 0, 1 from 0.3 on.
inline float direction_confidence(float gap) {
    const float x = gap / 0.3f;
    return x >= 1 ? 1.0f : x > 0 ? x * x : 0.0f;
}

/// Returns the surface in the form that extract_lines takes.
LineSurface line_surface(const HatchingSurface& surface);

/// Returns directions along lines on a surface, completed between them: V unit tangents, or zeros if there are no
/// lines.
std::vector<Vec3> complete_line_directions(const DirectionSmoother& smoother, const HatchingSurface& surface,
                                           std::span<const LineSegment> segments);
/// Returns the same for the surface's ridges or valleys.
std::vector<Vec3> complete_line_directions(const DirectionSmoother& smoother, const HatchingSurface& surface,
                                           LineType type);

}  // namespace exemplar
