#pragma once

#include <functional>
#include <vector>

#include "host/hatching/drawing/drawing_alignment.h"
#include "host/hatching/tracing/ink_mask.h"
#include "host/hatching/tracing/region_outline.h"

namespace exemplar {

/// A region as matching sees it, in pixels of a small image.
struct RegionShape {
    std::vector<Vec2> border;
    std::vector<Vec2> inside;    ///< places that are to be covered
    FloatImage distance;         ///< signed_distance
    Vec2 center = Vec2::Zero();  ///< of its bounding box
    float size = 0;              ///< the longer side of that
};
/// The shape of a region that is not empty; `inside` are pixels of `ink`, which is within it.
RegionShape region_shape(const PixelMask& region, const PixelMask& ink);

/// How badly one region lies in another: the mean truncated distances of the first's border to the second's and of the
/// second's to the first's, and how far the first reaches out of the second, all in units of `reach` pixels; 0 if they
/// are the same, 2 if nothing fits.
float misfit(const RegionShape& drawing, const RegionShape& object, const Similarity& to_object, float reach);

struct SearchRange {
    float largest_tilt = 0;
    bool quarter_turns = true;
};
/// The places where the drawing lies best in the object, best first, by a search of all scales between about half and
/// one and a half times what makes them equally large, refined: at most `count`, different from each other. Both shapes
/// have about the same size.
std::vector<Similarity> best_places(const RegionShape& drawing, const RegionShape& object, const SearchRange& range,
                                    std::size_t count);

/// Minimizes a function of a similarity near `start` by Subplex; steps move places a radius from the center of the
/// object by about `step` pixels.
Similarity refined(const Similarity& start, const Vec2& center, float radius, float step,
                   const std::function<double(const Similarity&)>& badness);

}  // namespace exemplar
