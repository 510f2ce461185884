#pragma once

#include <vector>

#include "host/hatching/drawing/aligned_drawing.h"
#include "host/hatching/drawing/drawing_sheet.h"
#include "host/hatching/tracing/stroke_paths.h"
#include "host/imaging/vectors/svg_reader.h"

namespace exemplar {

/// A drawing in lines: nothing has to be traced or estimated.
struct SvgDrawing {
    double width = 0, height = 0;   ///< of the page, in its units
    std::vector<StrokePath> paths;  ///< in units of the page
};

/// Returns the strokes of an SVG. Those in groups named "outline", "outlines", "contour" or "contours" (in any case)
/// are outlines; other feature lines that 'exemplar hatch draw' adds are left out, and so are colored strokes beside
/// more ink without color. Paths that go on where the one before ended, as pens of changing width are written, are one
/// stroke. Darkness is that over white. Throws DataError if nothing is left.
SvgDrawing svg_drawing(const SvgPicture& picture);

/// Draws the page `width` pixels wide: darkness, one channel. Throws UsageError for more than 2^28 pixels.
FloatImage svg_darkness(const SvgDrawing& drawing, int width);

/// Measures the strokes of a page that is the view, if it has as many units as that has pixels. Any other page is
/// aligned with the view, as a picture would be. Throws DataError if it does not fit.
AlignedDrawing align_and_measure(const SvgDrawing& drawing, const PixelFeatures& pixels);
/// Measures the strokes of a page that shows exactly the view. Throws DataError if it has another aspect ratio.
AlignedDrawing measure_in_place(const SvgDrawing& drawing, const PixelFeatures& pixels);
/// Measures the strokes of a page that is the whole sheet. Throws DataError if it has another aspect ratio.
AlignedDrawing measure_on_sheet(const SvgDrawing& drawing, const DrawingSheet& sheet, const PixelFeatures& pixels);

}  // namespace exemplar
