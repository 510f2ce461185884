#pragma once

#include "host/imaging/image.h"
#include "host/mesh/mesh.h"

namespace exemplar {

/// Turns, scales and moves places of an image.
class Similarity {
  public:
    Similarity() = default;
    /// Turns by `rotation` radians from the x axis towards the y axis (clockwise on the screen) and scales about the
    /// origin, then moves by (x, y) pixels.
    Similarity(double scale, double rotation, double x = 0, double y = 0);

    double scale() const;
    /// In [-pi, pi].
    double rotation() const;
    Vec2 apply(const Vec2& place) const {
        const auto px = static_cast<double>(place.x()), py = static_cast<double>(place.y());
        return {static_cast<float>(cosine_ * px - sine_ * py + x_), static_cast<float>(sine_ * px + cosine_ * py + y_)};
    }
    Similarity inverse() const;
    /// First this, then another.
    Similarity then(const Similarity& next) const;
    Similarity moved(double x, double y) const;

  private:
    double cosine_ = 1, sine_ = 0;  ///< times the scale
    double x_ = 0, y_ = 0;
};

struct AlignmentOptions {
    float largest_tilt = 0.21f;     ///< radians: how crooked the sheet may lie, either way
    bool quarter_turns = true;      ///< whether it may lie on another side, too
    float least_explained = 0.38f;  ///< share of the object's border that the drawing's must lie on
    float most_outside = 0.15f;     ///< share of the ink that may lie outside of the object
};

/// How a drawing lies over the view it was made for.
struct DrawingAlignment {
    Similarity to_view;       ///< from pixels of the drawing to pixels of the view
    float residual = 0;       ///< view pixels: root mean square distance of the borders where they lie on each other
    float explained = 0;      ///< share of the object's border where they do
    float outside = 0;        ///< share of the ink that lies outside of the object
    bool same_frame = false;  ///< the drawing was taken for one of the whole view, as tablets make them
};

/// Finds how a drawing (what drawing_darkness gives; of any resolution, with any margins, turned a little or by quarter
/// turns) lies over a view in which the object covers the pixels of `object` that are not zero (thesis App. B.1:
/// matching borders with brute force search). The drawing may be of hatching alone, and lit parts of it blank: what
/// counts is how well the border of the inked region lies on the object's where it is near it, how much of the object's
/// border has ink at it, and that there is none outside. All scales, tilts and places are tried on a coarse grid, the
/// best ones are refined (NLopt's Subplex) and the very best is at the view's full resolution, with a loss that does
/// not mind strokes ending short of the border: only where the drawing's border and the object's run alike do they draw
/// each other, and strokes along the border are expected half a spacing inside. A drawing of the view's aspect ratio
/// that fits if it is just scaled to the view's size is left at that unless another place is clearly better. A border
/// without corners does not tell how the drawing is turned. Throws UsageError if an image has not one channel or the
/// object no pixel, DataError for a drawing without ink, and for one that fits nowhere.
DrawingAlignment align_drawing(const FloatImage& darkness, const Image& object, const AlignmentOptions& options = {});

/// The drawing as the view has it: width x height pixels, each the mean of what it covers of the drawing, and 0 (paper)
/// where that is beyond its border. Throws UsageError if the drawing has not one channel or the view no pixels.
FloatImage warp_drawing(const FloatImage& darkness, const Similarity& to_view, int width, int height);

}  // namespace exemplar
