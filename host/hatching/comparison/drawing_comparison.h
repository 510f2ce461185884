#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "host/hatching/fields/hatching_fields.h"
#include "host/hatching/measurement/drawing_properties.h"
#include "host/hatching/measurement/stroke_measurements.h"
#include "host/hatching/tracing/ink_mask.h"
#include "host/hatching/tracing/view_outlines.h"
#include "host/imaging/image.h"

namespace exemplar {

/// A drawing of a view, as it is compared with another one: what its pixels show, whoever or whatever drew it.
struct ComparedDrawing {
    FloatImage darkness;  ///< see drawing_darkness; of the view's size
    StrokeMeasurements strokes;
};

/// How a drawing differs from an artist's of the same view. It needs no known rule and no model.
struct DrawingComparison {
    // Pixels that both have inked, where both have a clear direction (a structure tensor's coherence above 0.6).
    std::size_t inked_by_both = 0;
    double direction_median = 0, direction_mean = 0;  ///< angle between the strokes of both, degrees
    double direction_off = 0;                         ///< share above 30 degrees
    // The hatched regions: ink closed by a disc of 6 pixels.
    double region_overlap = 0;        ///< intersection over union
    std::array<double, 2> hatched{};  ///< share of the object: the artist's, the drawing's
    /// Correlation of both blurred by Gaussians of 1, 2 and 4 of the artist's median spacings.
    std::array<double, 3> tone{};
    std::array<double, 2> ink{};  ///< mean darkness, in [0, 1]: the artist's, the drawing's
    /// Share of the object's pixels by the artist's level (first index) and the drawing's.
    std::array<std::array<double, k_cross_hatching + 1>, k_cross_hatching + 1> level{};
    double level_right = 0;  ///< share of equal levels
    /// The drawing's value over the artist's, where both have strokes within 3 pixels of each other: the median, and
    /// the median factor by which it is off, at least 1. By StrokeProperty; 0 where no strokes are near.
    std::array<double, k_stroke_properties> ratio{}, factor{};
};

/// Returns the part of the object that counts in comparisons: the pixels of a G-buffer's object but for those within
/// 3.5 pixels of its outlines, so that neither drawn outlines nor their absence counts.
PixelMask compared_pixels(const GBuffer& gbuffer, const ViewOutlines& outlines);

/// Compares a drawing with an artist's in the pixels of `mask`. All have the same size, or it throws UsageError;
/// DataError if nothing is left to compare.
DrawingComparison compare_drawings(const ComparedDrawing& artist, const ComparedDrawing& drawing,
                                   const PixelMask& mask);

/// Shows where directions differ: the ink of both in gray; the drawing's strokes that both inked green up to 15
/// degrees off, yellow up to 30, red beyond. RGB.
Image comparison_picture(const ComparedDrawing& artist, const ComparedDrawing& drawing, const PixelMask& mask);

}  // namespace exemplar
