#pragma once

#include <vector>

#include "host/lines/extraction/lines.h"

namespace exemplar {

/// Quantities at a vertex that determine the lines in the faces around it. Members are interpolated linearly in a face.
struct LineField {
    /// Zero sets: the function whose zeros are the line. Extrema: positive where there may be a line.
    float value = 0;
    float strength = 0;  ///< compared with the threshold; dimensionless
    float margin = 0;    ///< positive where the test against the threshold is passed; in any unit
    float front = 1;     ///< positive where the surface faces the eye; 1 if back faces are not cut off
    /// Zero sets: the axis along which `value` is measured if its sign is arbitrary, else zero. Extrema: the
    /// direction in which the function grows, scaled by its derivative.
    Vec3 direction = Vec3::Zero();
};

/// Computes the field of suggestive contours or highlights.
std::vector<LineField> radial_curvature_field(const LineSurface& surface, LineType type, const LineOptions& options);
/// Computes the field of principal highlights along e1 (axis 0) or e2 (axis 1).
std::vector<LineField> principal_highlight_field(const LineSurface& surface, int axis, const LineOptions& options);
std::vector<LineField> contour_field(const LineSurface& surface, const LineOptions& options);
/// Computes the field of ridges or valleys.
std::vector<LineField> crest_field(const LineSurface& surface, LineType type, const LineOptions& options);
std::vector<LineField> apparent_ridge_field(const LineSurface& surface, const LineOptions& options);

}  // namespace exemplar
