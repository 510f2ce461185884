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
    std::size_t segments = 0;  ///< that were found, hidden ones too
    std::vector<Stroke> strokes;
};

/// A line drawing of a surface.
struct Drawing {
    int width = 0, height = 0;         ///< pixels
    std::vector<DrawingLayer> layers;  ///< in the order in which they are drawn
    /// Wall time that its steps took.
    struct Seconds {
        double lines = 0, visibility = 0, strokes = 0;
    } seconds;
};

/// Types in the order in which they are drawn: highlights first, contours last, so that what says most is on top.
std::span<const LineType> drawing_order();

/// The drawing of all lines of some types that a camera sees, with thresholds and thickness of the style; hidden parts
/// are marked in the strokes, but for gaps of up to three pixels in lines across smooth surfaces (see close_gaps).
/// Creases and boundaries are those of `edges`: the same surface with the same faces, where `surface` was cut open
/// along them (see split_at_creases); null: of `surface`. With contours, creases that are outlines, as one of their
/// faces is turned away from the eye, are drawn as contours. Throws UsageError as extract_lines and make_strokes.
Drawing draw_lines(const LineSurface& surface, std::span<const LineType> types, const DrawingStyle& style,
                   const StrokeView& view, const LineSurface* edges = nullptr,
                   const VisibilityOptions& visibility = {});

/// Both as one drawing, `right` beside `left`. Throws UsageError unless they have the same layers and are equally high.
Drawing side_by_side(Drawing left, const Drawing& right);

/// What is visible of a stroke without a gap.
struct StrokeRun {
    std::vector<StrokePoint> points;  ///< two or more; of a closed run the last is the first
    bool closed = false;
};
/// The visible runs of a stroke, along it. One that goes over the start of a closed stroke is in one piece, and its
/// parameters grow on.
std::vector<StrokeRun> visible_runs(const Stroke& stroke);
/// Length of a run in pixels.
float length_of(const StrokeRun& run);

}  // namespace exemplar
