#pragma once

#include "host/imaging/image.h"
#include "host/mesh/mesh.h"

namespace exemplar {

/// A similarity transform of an image: rotation, scaling and translation.
class Similarity {
  public:
    Similarity() = default;
    /// Rotates by `rotation` radians from the x axis towards the y axis (clockwise on the screen) and scales about
    /// the origin, then translates by (x, y) pixels.
    Similarity(double scale, double rotation, double x = 0, double y = 0);

    double scale() const;
    /// Radians in [-pi, pi].
    double rotation() const;
    Vec2 apply(const Vec2& place) const {
        const auto px = static_cast<double>(place.x()), py = static_cast<double>(place.y());
        return {static_cast<float>(cosine_ * px - sine_ * py + x_), static_cast<float>(sine_ * px + cosine_ * py + y_)};
    }
    Similarity inverse() const;
    /// Returns this transform followed by `next`.
    Similarity then(const Similarity& next) const;
    Similarity moved(double x, double y) const;

  private:
    double cosine_ = 1, sine_ = 0;  ///< times the scale
    double x_ = 0, y_ = 0;
};

struct AlignmentOptions {
    float max_tilt = 0.21f;       ///< max tilt of the sheet to either side, radians
    bool quarter_turns = true;    ///< whether it may be rotated by quarter turns, too
    float min_explained = 0.38f;  ///< min share of the object's border that the drawing's lies on
    float max_outside = 0.15f;    ///< max share of the ink outside of the object
};

/// The placement of a drawing over the view it was made for.
struct DrawingAlignment {
    Similarity to_view;       ///< from pixels of the drawing to pixels of the view
    float residual = 0;       ///< view pixels: RMS distance of the borders where they lie on each other
    float explained = 0;      ///< share of the object's border where they do
    float outside = 0;        ///< share of the ink that lies outside of the object
    bool same_frame = false;  ///< the drawing was taken to show the whole view, as tablets make them
};

/// Finds the placement of a drawing over a view in which the object covers the nonzero pixels of `object`, by
/// brute-force matching of borders (thesis App. B.1). `darkness`: see drawing_darkness; any resolution and margins,
/// tilted a little, rotated by quarter turns; lit parts may be blank. A drawing of the view's aspect ratio is only
/// scaled to the view's size unless another placement is clearly better. A border without corners leaves the
/// rotation undetermined. Throws UsageError if an image has not one channel or the object no pixel, DataError for a
/// drawing without ink, and for one that fits nowhere.
DrawingAlignment align_drawing(const FloatImage& darkness, const Image& object, const AlignmentOptions& options = {});

/// Resamples the drawing in the view: width x height pixels, each the mean of what it covers of the drawing, and 0
/// (paper) beyond the drawing's border. Throws UsageError if the drawing has not one channel or the view no pixels.
FloatImage warp_drawing(const FloatImage& darkness, const Similarity& to_view, int width, int height);

}  // namespace exemplar
