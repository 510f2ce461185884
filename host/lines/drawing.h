#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "host/lines/extraction/lines.h"
#include "host/lines/strokes/strokes.h"
#include "host/lines/strokes/style.h"
#include "host/lines/strokes/visibility.h"

namespace exemplar {

/// The strokes of one line type.
struct DrawingLayer {
    LineType type = LineType::contours;
    std::size_t segments = 0;  ///< number found, including hidden ones
    std::vector<Stroke> strokes;
};

/// A line drawing of a surface.
struct Drawing {
    int width = 0, height = 0;         ///< pixels
    std::vector<DrawingLayer> layers;  ///< in drawing order
    /// Wall time of the steps.
    struct Seconds {
        double lines = 0, visibility = 0, strokes = 0;
    } seconds;
};

/// Returns the line types in drawing order: highlights first, contours last, so that the most important are on top.
std::span<const LineType> drawing_order();

/// Draws all lines of some types as a camera sees them, with thresholds and thickness of the style. Hidden parts are
/// marked in the strokes; in lines across smooth surfaces hidden gaps of up to three pixels are closed (close_gaps).
/// If contours are drawn, creases on the outline are drawn as contours only, and so are boundaries if they are not
/// drawn as such. Throws UsageError as extract_lines and make_strokes do.
Drawing draw_lines(const LineSurface& surface, std::span<const LineType> types, const DrawingStyle& style,
                   const StrokeView& view, const VisibilityOptions& visibility = {});

/// Returns one drawing with `right` beside `left`. Throws UsageError if their layers or heights differ.
Drawing side_by_side(Drawing left, const Drawing& right);

/// A visible part of a stroke without a gap.
struct StrokeRun {
    std::vector<StrokePoint> points;  ///< two or more; in a closed run the last equals the first
    bool closed = false;
};
/// Returns the visible runs of a stroke in order. A run across the start of a closed stroke is one piece, along
/// which parameters keep increasing.
std::vector<StrokeRun> visible_runs(const Stroke& stroke);
/// Returns the parts of a run within the picture, in order; width and height in pixels. A part of a closed run across
/// its start is one piece.
std::vector<StrokeRun> within_picture(const StrokeRun& run, int width, int height);
/// Returns the length of a run in pixels.
float length_of(const StrokeRun& run);

}  // namespace exemplar
