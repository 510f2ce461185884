#pragma once

#include <vector>

#include "host/lines/extraction/lines.h"

namespace exemplar {

/// What decides at a vertex about lines in the faces around it; between the corners of a face, each is linear.
struct LineField {
    /// Zero sets: the function whose zeros the line is. Extrema: positive where there may be a line.
    float value = 0;
    float strength = 0;  ///< what the threshold bounds, dimensionless
    float margin = 0;    ///< by how much (in whatever unit) the test of strength is passed
    float front = 1;     ///< positive where the surface faces the eye, if only that part is asked for
    /// Zero sets: the axis that `value` is taken along, if its sign is arbitrary; else zero. Extrema: the direction in
    /// which the function grows, as long as its derivative.
    Vec3 direction = Vec3::Zero();
};

/// Suggestive contours or highlights.
std::vector<LineField> radial_curvature_field(const LineSurface& surface, LineType type, const LineOptions& options);
/// Principal highlights along e1 (axis 0) or e2 (axis 1).
std::vector<LineField> principal_highlight_field(const LineSurface& surface, int axis, const LineOptions& options);
std::vector<LineField> contour_field(const LineSurface& surface, const LineOptions& options);
/// Ridges or valleys.
std::vector<LineField> crest_field(const LineSurface& surface, LineType type, const LineOptions& options);
std::vector<LineField> apparent_ridge_field(const LineSurface& surface, const LineOptions& options);

}  // namespace exemplar
