#pragma once

#include <span>

#include "host/hatching/measurement/stroke_map.h"
#include "host/hatching/tracing/ink_mask.h"
#include "host/hatching/tracing/traced_strokes.h"
#include "host/imaging/image.h"

namespace exemplar {

/// Measures the orientation of points: the eigenvector of the smaller eigenvalue of the structure tensor of the
/// darkness, summed over the stroke's own pixels within about twice its width. Leaves the orientation as it is where
/// much of the surroundings belongs to other strokes, which would bias it.
void measure_orientations(const FloatImage& darkness, const StrokeMap& map, const PixelMask& crossing_pixels,
                          std::span<TracedStroke> strokes);

/// Estimates how soft the edges of strokes are: the standard deviation, in pixels, of a Gaussian that blurred the
/// drawing after each pixel got the share that strokes cover. Returns the one that explains the profiles best, or
/// zero if sharp edges explain them as well. Strokes about as narrow as the blur cannot tell the two apart; drawings
/// then count as sharp, and strokes as wide as they look. `paper`: mean darkness of paper.
float estimate_softness(const FloatImage& darkness, float paper, const StrokeMap& map, const PixelMask& crossing_pixels,
                        std::span<const TracedStroke> strokes);

/// Measures thickness, intensity and center of each point: fits a box of that width and darkness, blurred by pixels
/// and softness, to the darkness of the stroke's own pixels nearby by least squares. At crossings, and where other
/// strokes are too near, interpolates along the stroke. Orientations that were not measured follow the center line.
/// Limits: a stroke narrower than a pixel is measured as a lighter one a pixel wide; where strokes are about as
/// narrow as the blur, wide and light looks like narrow and dark. Thickness times intensity is right in either case.
void measure_profiles(const FloatImage& darkness, float paper, float softness, const StrokeMap& map,
                      const PixelMask& crossing_pixels, std::span<TracedStroke> strokes);

/// Measures the length of each stroke: that of its center line, between the centers of its round ends. Thinning
/// moves the ends, so they are searched for where the ink along the stroke falls below half.
void measure_lengths(const FloatImage& darkness, std::span<TracedStroke> strokes);

/// Measures the spacing at each point: the distance, across the stroke, to the center lines of the nearest strokes
/// of similar orientation (within `similar` radians) that do not cross it. It is the mean of both sides, or the
/// nearer one if the other is much farther. A neighbor whose own spacing is less than half as large does not count:
/// an outline along hatches is not of their family. Zero if there is none within `largest`.
void measure_spacings(std::span<const StrokeCrossing> crossings, float similar, float largest,
                      std::span<TracedStroke> strokes);

/// Averages the properties of points with a Gaussian of `sigma` pixels: thickness, intensity, spacing and length
/// over all points, orientation over those within `similar` radians of the own. Points are weighted by thickness, as
/// thicker strokes cover more pixels. Points at crossings, and properties that were not measured, do not count.
/// Spacings of zero neither count nor change.
void smooth_properties(float sigma, float similar, std::span<TracedStroke> strokes);

}  // namespace exemplar
