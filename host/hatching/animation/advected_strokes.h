#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "host/hatching/features/hatching_view.h"
#include "host/hatching/fields/hatch_stroke.h"
#include "host/imaging/gbuffer.h"
#include "host/mesh/mesh.h"

namespace exemplar {

/// A point of a stroke on the surface; it stays there when the surface moves.
struct SurfacePoint {
    std::uint32_t face = k_no_face;      ///< k_no_face: not on the surface
    std::array<float, 2> barycentric{};  ///< of corners 1 and 2; may lie slightly outside of the face
    bool counter_clockwise = true;       ///< orientation of the corners in the view
};

/// A stroke on the surface.
struct SurfaceStroke {
    std::size_t layer = 0;
    std::vector<SurfacePoint> places;  ///< one per point
};

/// Projects the strokes of a view to the surface that it shows. A point goes to the face that its pixel shows, where
/// the ray through the point meets the face's plane; if that is far off because the face is seen edge-on, where the
/// ray through the center of the pixel does. `gbuffer` is of that mesh and view. Throws UsageError if sizes do not
/// fit.
std::vector<SurfaceStroke> strokes_on_surface(std::span<const HatchStroke> strokes, const TriangleMesh& mesh,
                                              const HatchingView& view, const GBuffer& gbuffer);

/// A part of a stroke of the previous frame, advected with the surface.
struct AdvectedStroke {
    HatchStroke stroke;              ///< without widths
    std::array<bool, 2> is_whole{};  ///< whether its first and its last point are those of the stroke
};

/// Projects strokes on the surface to a view. Omits points that left the picture, turned away from the eye, or are
/// hidden: over 1/200 of the depth range behind all that their pixel and the eight around it show. Strokes split
/// where two points are over 16 pixels apart. The last segment of each part is extended by at most half a pixel, so
/// that clipping, in steps of a pixel, does not shorten strokes from frame to frame. Throws UsageError if sizes do
/// not fit, or the mesh has no such face.
std::vector<AdvectedStroke> advected_strokes(std::span<const SurfaceStroke> strokes, const TriangleMesh& mesh,
                                             const HatchingView& view, const GBuffer& gbuffer);

}  // namespace exemplar
