#pragma once

#include <span>

#include "host/hatching/tracing/ink_mask.h"
#include "host/hatching/measurement/stroke_map.h"
#include "host/hatching/tracing/traced_strokes.h"
#include "host/imaging/image.h"

namespace exemplar {

/// Orientation of points: the eigenvector of the smaller eigenvalue of the structure tensor of the darkness, summed
/// over the stroke's own pixels within about twice its width. Where much of what is around belongs to other strokes,
/// which would turn it, the orientation is left as it is.
void measure_orientations(const FloatImage& darkness, const StrokeMap& map, const PixelMask& crossing_pixels,
                          std::span<TracedStroke> strokes);

/// How soft the edges of strokes are: the standard deviation, in pixels, of a Gaussian that blurred the drawing after
/// each pixel had got the share of it that strokes cover. It is what explains the profiles of strokes best, but zero
/// where that explains them as well; strokes about as narrow as the blur cannot tell the two apart, so then drawings
/// count as sharp and strokes as wide as they look. `paper` is the mean darkness of paper.
float estimate_softness(const FloatImage& darkness, float paper, const StrokeMap& map, const PixelMask& crossing_pixels,
                        std::span<const TracedStroke> strokes);

/// Thickness and intensity of each point, and its place on the center line to a fraction of a pixel: the box of that
/// width and darkness that, blurred by pixels and softness, fits the darkness of the stroke's own pixels nearby best in
/// the least-squares sense. At crossings, and where other strokes are too near, they are interpolated along
/// the stroke. Orientations that the drawing could not tell follow the center line.
void measure_profiles(const FloatImage& darkness, float paper, float softness, const StrokeMap& map,
                      const PixelMask& crossing_pixels, std::span<TracedStroke> strokes);

/// Length of each stroke: of its center line, that is, between the centers of its round ends. Thinning does not keep
/// ends where they were, so they are looked for where the ink along the stroke falls below half.
void measure_lengths(const FloatImage& darkness, std::span<TracedStroke> strokes);

/// Spacing at each point: the distance, across the stroke, of the center lines of the nearest strokes of similar
/// orientation (within `similar` radians) that do not cross it: the mean of those on its two sides, or the nearer if
/// the other is much farther. A stroke whose neighbors' own spacing is less than half as large, as an outline along
/// hatches, does not count as theirs. Zero where there is none within `largest`.
void measure_spacings(std::span<const StrokeCrossing> crossings, float similar, float largest,
                      std::span<TracedStroke> strokes);

/// Averages the properties of the points with a Gaussian of `sigma` pixels: thickness, intensity, spacing and length
/// over all, orientation over those within `similar` radians of the own. Points count by their thickness, as a stroke
/// covers more pixels the thicker it is, but not at crossings, nor with properties that were not measured there.
/// Spacings of zero neither count nor change.
void smooth_properties(float sigma, float similar, std::span<TracedStroke> strokes);

}  // namespace exemplar
