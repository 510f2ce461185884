#pragma once

#include <cstdint>
#include <vector>

#include "host/hatching/tracing/traced_strokes.h"
#include "host/imaging/gbuffer.h"

namespace exemplar {

/// The outlines of a view: where the surface ends before the background or before a farther part of itself (see
/// occlusion_barriers). They run through pixels of the nearer side.
struct ViewOutlines {
    int width = 0, height = 0;
    std::size_t count = 0;              ///< number of pixels that outlines run through
    std::vector<std::int32_t> nearest;  ///< per pixel: index of the nearest of them; k_no_site: there are none
    std::vector<float> direction;       ///< per pixel of an outline: along it, radians in [0, pi)

    /// Returns the distance in pixels from the center of a pixel to the nearest outline pixel's; infinity if there
    /// are none.
    float distance(std::size_t pixel) const;
};
ViewOutlines view_outlines(const GBuffer& gbuffer);

/// Takes outlines that were drawn by hand out of the strokes of a drawing, and returns them. A part of a stroke is an
/// outline if it lies within `reach` pixels of the view's outlines and runs along them, within 30 degrees. The rest
/// of its stroke stays, unless it is shorter than `reach`. Takes nothing if such parts accompany less than half of
/// the view's outlines: then the drawing has none, and strokes along the outline are hatching.
std::vector<TracedStroke> take_outlines(std::vector<TracedStroke>& strokes, const ViewOutlines& outlines, float reach);

}  // namespace exemplar
