#pragma once

#include <vector>

#include "host/hatching/drawing/drawing_warp.h"
#include "host/hatching/tracing/ink_mask.h"

namespace exemplar {

constexpr float k_smoothed_ink_darkness = 0.1f;  ///< min darkness of ink, after smoothing
constexpr std::size_t k_border_points = 800;

/// The object at the view's resolution.
struct ViewObject {
    FloatImage distance;       ///< to the border, signed
    std::vector<Vec2> border;  ///< at most k_border_points
    Vec2 center;
    float size;  ///< longer side of the bounding box
};

/// Places on one border that are to lie on another. Only places where the two borders run alike vote: where hatching
/// ends in the middle of the object, because the rest is lit, its border crosses the object's and would attract it.
struct BorderVotes {
    struct Vote {
        Vec2 place;
        float inset;  ///< how far inside of the object to expect ink, give or take as much
    };
    std::vector<Vote> cast;
    std::size_t all = 0;  ///< number of places; those without a vote count as fitting nowhere
};

/// The drawing in the view, under some placement.
struct ViewDrawing {
    BorderVotes ends;      ///< of strokes
    BorderVotes contacts;  ///< ink at the inked region's border: ends of strokes, and outermost strokes
    BorderVotes hull;      ///< the border of the object
    std::vector<Vec2> ink;
    FloatImage distance;  ///< to the border of the inked region, signed
};

/// Returns the region that strokes fill: closes gaps between them, removes dust, fills holes. `size`: of the object,
/// in pixels.
PixelMask inked_region(const PixelMask& ink, float size);
/// Returns the pixels that are set in both masks.
PixelMask intersection(PixelMask first, const PixelMask& second);
/// Returns the drawing under a placement. `with_ends` traces the strokes, too, to find their ends.
ViewDrawing drawing_in_view(const FloatImage& darkness, const Similarity& to_view, const ViewObject& object,
                            bool with_ends);
/// Returns the loss of a placement after a small change. Ink at the drawing's border should lie at the object's, and
/// the object's border should have ink, but neither counts where they are far apart; ink should not lie outside.
/// `half`: the distance in pixels that counts half.
double placement_loss(const ViewDrawing& drawing, const ViewObject& object, const Similarity& change, float half);

}  // namespace exemplar
