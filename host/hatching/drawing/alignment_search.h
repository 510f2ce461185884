#pragma once

#include <functional>
#include <vector>

#include "host/hatching/drawing/drawing_warp.h"
#include "host/hatching/tracing/ink_mask.h"
#include "host/hatching/tracing/region_outline.h"

namespace exemplar {

/// A region in the form that matching uses, in pixels of a small image.
struct RegionShape {
    std::vector<Vec2> border;
    std::vector<Vec2> inside;    ///< places that the other region is to cover
    FloatImage distance;         ///< signed_distance
    Vec2 center = Vec2::Zero();  ///< of its bounding box
    float size = 0;              ///< longer side of its bounding box
};
/// Returns the shape of a region that is not empty; `inside` samples the pixels of `ink`, which lies within it.
RegionShape region_shape(const PixelMask& region, const PixelMask& ink);

/// Returns how badly one region lies in another: the mean truncated distances of the first's border to the second's
/// and of the second's to the first's, and four times how far the first reaches out of the second. Distances are in
/// units of `reach` pixels, where they are truncated; 0 if both are the same, 6 if nothing fits.
float misfit(const RegionShape& drawing, const RegionShape& object, const Similarity& to_object, float reach);

struct SearchRange {
    float max_tilt = 0;
    bool quarter_turns = true;
};
/// Finds the placements in which the drawing lies best in the object: at most `count`, different from each other,
/// best first. Searches all scales between about half and one and a half times what makes both equally large, then
/// refines. Both shapes have about the same size.
std::vector<Similarity> best_places(const RegionShape& drawing, const RegionShape& object, const SearchRange& range,
                                    std::size_t count);

/// Minimizes a function of a similarity near `start` by Subplex. The initial steps move places at a distance of
/// `radius` from the center of the object by about `step` pixels.
Similarity refined(const Similarity& start, const Vec2& center, float radius, float step,
                   const std::function<double(const Similarity&)>& badness);

}  // namespace exemplar
