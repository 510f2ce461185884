#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "host/hatching/fields/hatch_stroke.h"
#include "host/hatching/features/hatching_view.h"
#include "host/imaging/gbuffer.h"
#include "host/mesh/mesh.h"

namespace exemplar {

/// Where a point of a stroke lies on the surface, whatever moves.
struct SurfacePlace {
    std::uint32_t face = k_no_face;      ///< k_no_face: beside the surface
    std::array<float, 2> barycentric{};  ///< of corners 1 and 2; a little over the face's border, too
    bool counter_clockwise = true;       ///< how the view showed the corners
};

/// A stroke that lies on the surface.
struct SurfaceStroke {
    std::size_t layer = 0;
    std::vector<SurfacePlace> places;  ///< of its points
};

/// Lays strokes of a view on the surface that it shows: each point into the face that its pixel shows, where the ray
/// through the point meets the face's plane, or, where that is far off as the face is seen from its edge, the ray
/// through the pixel's center. `gbuffer` is of that mesh and view. Throws UsageError if sizes do not fit.
std::vector<SurfaceStroke> strokes_on_surface(std::span<const HatchStroke> strokes, const TriangleMesh& mesh,
                                              const HatchingView& view, const GBuffer& gbuffer);

/// A part of a stroke of the picture before, where the surface has carried it.
struct CarriedStroke {
    HatchStroke stroke;              ///< without widths
    std::array<bool, 2> is_whole{};  ///< its first and its last point are those of the stroke
};

/// Those strokes where the surface is now, without what left the picture, turned away from the eye or is hidden
/// (farther than all that the pixel and the eight around it show by over 1/200 of the range of depths). What tears, by
/// more than 16 pixels from a point to the next, becomes two. The last piece is made longer by half a pixel at most, so
/// that strokes that are kept, in steps of a pixel, do not shrink from picture to picture. Throws UsageError if sizes
/// do not fit, or the mesh has no such face.
std::vector<CarriedStroke> carried_strokes(std::span<const SurfaceStroke> strokes, const TriangleMesh& mesh,
                                           const HatchingView& view, const GBuffer& gbuffer);

}  // namespace exemplar
