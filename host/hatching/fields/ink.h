#pragma once

#include <span>
#include <vector>

#include "host/hatching/fields/hatch_stroke.h"
#include "host/hatching/fields/hatching_fields.h"
#include "host/imaging/image.h"

namespace exemplar {

/// Renders strokes: returns the darkness of each pixel, row by row, as the mean over 16 samples in the pixel. A
/// stroke covers the samples within half of its width of its center line, each once; a sample covered by strokes of
/// darkness a and b gets 1 - (1 - a)(1 - b). The result does not depend on the number of threads. Throws UsageError
/// for strokes with different numbers of points and widths, or with values that are not finite.
std::vector<float> render_ink(std::span<const HatchStroke> strokes, int width, int height);

/// Returns the darkness of pixels as a gray picture, dark on light.
Image ink_picture(std::span<const float> ink, int width, int height);

/// Returns the target tone of each pixel, in the measure of render_ink(): t = thickness x intensity / spacing, at
/// most the intensity, where one layer is hatched; 1 - (1 - t)^2 where two are.
std::vector<float> target_tone(const HatchingFields& fields);

/// Means over square windows of an image, clipped at its borders; uses a summed-area table.
class WindowMeans {
  public:
    WindowMeans(std::span<const float> values, int width, int height);
    /// Returns the mean of the pixels at most `reach` (not negative) from (x, y) along both axes.
    double mean(int x, int y, int reach) const;

  private:
    int width_, height_;
    std::vector<double> sums_;  // sums of the pixels above and left of each pixel's upper left corner
};

}  // namespace exemplar
