#pragma once

#include <cstdint>

#include "host/lines/extraction/lines.h"

namespace exemplar {

/// Returns whether a side of a face is an outline of the polygons: whether, as the eye sees them, all faces at the edge
/// are on one side of it. Orientation does not matter. A face that is seen edge-on is on no side; the edge is an
/// outline if it is the nearer end of that face. A side of a single face always is one. False if another face stands
/// for the edge and it is no outline, too.
bool is_outline(const LineSurface& surface, std::uint32_t face, std::uint32_t side, const LineOptions& options);

/// The part of a side between two places, 0 at its first corner and 1 at its second; none if from = to.
struct SidePart {
    float from = 0, to = 0;
};
/// Returns the part of a sharp side that is a contour: all of it if it is an outline of the polygons, else where the
/// smooth normals face the eye on one side of the edge and not on the other (at least from the first such place to the
/// last). Together with the zeros of n.w within smooth parts these bound what faces the eye.
SidePart contour_along(const LineSurface& surface, std::uint32_t face, std::uint32_t side, const LineOptions& options);

}  // namespace exemplar
