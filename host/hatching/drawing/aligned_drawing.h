#pragma once

#include "host/hatching/drawing/drawing_alignment.h"
#include "host/hatching/features/pixel_features.h"
#include "host/hatching/measurement/stroke_measurements.h"
#include "host/imaging/image.h"

namespace exemplar {

/// Returns the pixels that show the object: 1 there, 0 elsewhere, one channel.
Image object_mask(const PixelFeatures& pixels);

/// A drawing aligned with a view.
struct AlignedDrawing {
    DrawingAlignment alignment;
    FloatImage darkness;  ///< of the view's size
    StrokeMeasurements strokes;
};
/// Aligns a drawing (dark on light, of any resolution) with the view of `pixels`, and measures its strokes;
/// outlines that were drawn are no strokes. Throws DataError if it is blank or does not fit the view.
AlignedDrawing align_and_measure(const Image& drawing, const PixelFeatures& pixels);
/// Does the same for a drawing that shows exactly the view, at any resolution. Throws DataError if it is blank or has
/// another aspect ratio than the view.
AlignedDrawing measure_in_place(const Image& drawing, const PixelFeatures& pixels);

/// Renders the shaded view on white, light enough to draw on: one channel.
Image drawing_template(PixelFeatures& pixels);

}  // namespace exemplar
