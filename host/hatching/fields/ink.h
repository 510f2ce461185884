#pragma once

#include <span>
#include <vector>

#include "host/hatching/fields/hatch_stroke.h"
#include "host/hatching/fields/hatching_fields.h"

namespace exemplar {

/// The share of each pixel that strokes darken, row by row: measured at 16 places of it. A stroke covers what is within
/// half of its width from its center line, once; ink that lies over ink lets through what both do, so that places
/// covered by strokes of darkness a and b are 1 - (1 - a)(1 - b) dark. The result does not depend on the number of
/// threads. Throws UsageError for strokes whose points and widths are not as many, or not finite.
std::vector<float> drawn_ink(std::span<const HatchStroke> strokes, int width, int height);

/// The tone that strokes are to have (the same measure): thickness x intensity / spacing, at most the intensity, of one
/// layer; 1 - (1 - t)^2 where there are two.
std::vector<float> target_tone(const HatchingFields& fields);

/// Means over square windows of an image, cut off at its borders.
class WindowMeans {
  public:
    WindowMeans(std::span<const float> values, int width, int height);
    /// Of the pixels no further than `reach` from (x, y) along both axes; 0 <= reach.
    double mean(int x, int y, int reach) const;

  private:
    int width_, height_;
    std::vector<double> sums_;  // of all above and left of a pixel's upper left corner
};

}  // namespace exemplar
