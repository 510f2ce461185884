#pragma once

#include <string>
#include <vector>

#include "host/hatching/stroke_measurements.h"
#include "host/imaging/image.h"

namespace exemplar {

/// A picture to look at, and what its colors mean.
struct PropertyPicture {
    std::string name;         ///< of a file, without its ending
    Image image;              ///< RGB
    float low = 0, high = 0;  ///< values of the lightest and the darkest color of the ramp; equal: there is no ramp
    std::string unit;         ///< of these values
};

/// What was measured of a drawing, to be seen: `orientation` (hue by direction: red along x, then yellow, green and
/// blue as it turns clockwise; darker where strokes cross, gray where nothing is hatched), `thickness`, `spacing`,
/// `length` and `intensity` (from light yellow to dark violet, evenly to the eye, over the range that all but the
/// outermost hundredths of the stroke pixels are in), `level` (white, blue, red), `strokes` (a color each),
/// `intersections` and `boundaries` (over the drawing). `darkness` is the drawing measured. Throws UsageError if it is
/// of another size.
std::vector<PropertyPicture> property_pictures(const StrokeMeasurements& measurements, const FloatImage& darkness);

}  // namespace exemplar
