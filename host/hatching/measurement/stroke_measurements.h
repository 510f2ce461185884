#pragma once

#include <cstddef>
#include <cstdint>
#include <numbers>
#include <vector>

#include "host/imaging/image.h"
#include "host/mesh/mesh.h"

namespace exemplar {

struct MeasuringOptions {
    float faintest = 0.1f;                          ///< darkness below which nothing is a stroke
    float similar = std::numbers::pi_v<float> / 6;  ///< radians between the strokes of one family
    float largest_spacing = 0;                      ///< pixels; 0: 20 median thicknesses, 24 at least
    std::size_t most_intersections_of_single = 4;   ///< regions with more are cross-hatched
    float smoothing = 1;                            ///< width of the Gaussian in median spacings; 0: none
};

/// What the strokes of a drawing are like (thesis Sec. 4.2, App. B.1). All are images of the same size, row by row from
/// the top left. What is given per stroke pixel is 0 elsewhere, and conventions are those of HatchingFields.
struct StrokeMeasurements {
    int width = 0, height = 0;
    std::vector<std::uint8_t> stroke;        ///< 1: a stroke's pixel inside of the object
    std::vector<std::uint8_t> skeleton;      ///< 1: on the center line of a stroke
    std::vector<std::int32_t> stroke_id;     ///< per stroke pixel: of the stroke it belongs to, from 0; -1 elsewhere
    std::vector<float> intensity;            ///< per stroke pixel, in (0, 1]
    std::vector<float> thickness;            ///< per stroke pixel, pixels, 1 at least
    std::vector<float> orientation;          ///< per stroke pixel, radians in [0, pi)
    std::vector<float> spacing;              ///< per stroke pixel, pixels; 0: no neighbor in reach, so no hatching
    std::vector<float> length;               ///< per stroke pixel, pixels
    std::vector<std::uint8_t> intersection;  ///< 1: stroke pixels where strokes overlap: orientations to be left out
    std::vector<Vec2> intersections;         ///< where strokes cross, in pixel coordinates
    std::vector<std::uint8_t> level;         ///< per pixel of the object: 0, 1 or 2
    std::vector<std::uint8_t> boundary;      ///< 1: on the boundary of a region of one level, or at a stroke's end
    float median_thickness = 0, median_spacing = 0;  ///< over points of center lines; 0: there are none
    float softness = 0;                              ///< standard deviation of the blur of the drawing's edges, pixels

    std::size_t size() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
};

/// Measures the strokes of a drawing (thesis App. B.1) where `mask` (one channel, not zero inside of the object)
/// allows; strokes outside are ignored. `darkness` is what drawing_darkness gives, of one channel. A drawing without
/// strokes gives zeros. Where the thesis is coarse, this does otherwise:
/// - Strokes are put together from the skeleton first, through crossings (see trace_strokes), and then measured one by
///   one. Pixels at crossings belong to no direction, so following pixels of similar orientation gets lost there.
/// - Thickness is not the distance to the nearest lighter pixel (half of it, give or take a pixel) but the width of the
///   box that fits a stroke's profile, and intensity its darkness: a pixel half covered is not a stroke half as dark.
///   What a drawing does not tell: a stroke narrower than a pixel looks like a lighter one a pixel wide, and is taken
///   for it; and where strokes are about as narrow as the blur of a scan, wide and light looks like narrow and dark.
///   The ink across the stroke (thickness times intensity) is right in either case.
/// - Spacing is between center lines. Neighbors are other strokes that do not cross the own, rather than what is not
///   connected inside of a circle, as cross-hatches connect everything; both sides count (see measure_spacings), as
///   the nearest neighbor alone is nearer than strokes are apart on average.
/// - Length follows whole strokes: at most about 35 degrees of turn over a crossing, a radius of four pixels elsewhere.
/// - Intersections are crossings of traced strokes that Harris corners in the drawing and the skeleton confirm: corners
///   alone are at the ends of strokes, too, and twice at crossings of small angles.
/// - Regions are closed rather than dilated, so that they end half a spacing beyond the last stroke, and separately for
///   each family of strokes. A region is cross-hatched where two families overlap with more than four intersections;
///   discs around intersections would leave gaps between them where the angle is small, and reach too far beyond them.
/// - Boundaries along the outline of the object are left out: everything ends there.
/// - The final smoothing averages directions among strokes of similar direction only.
/// The result does not depend on the number of threads. Throws UsageError if an image has not one channel, or the sizes
/// differ.
StrokeMeasurements measure_strokes(const FloatImage& darkness, const Image& mask, const MeasuringOptions& options = {});

}  // namespace exemplar
