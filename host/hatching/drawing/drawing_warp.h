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

/// Resamples the drawing in the view: width x height pixels, each the mean of what it covers of the drawing, and 0
/// (paper) beyond the drawing's border. Throws UsageError if the drawing has not one channel or the view no pixels.
FloatImage warp_drawing(const FloatImage& darkness, const Similarity& to_view, int width, int height);

}  // namespace exemplar
