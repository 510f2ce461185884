#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "host/lines/drawing.h"
#include "host/lines/part_inks.h"
#include "host/lines/strokes/style.h"

namespace exemplar {

/// How strokes are converted to paths.
enum class SvgForm {
    lines,    ///< center lines with a stroke width, cut where it changes: for plotters and line editors
    outlines  ///< filled shapes whose width varies smoothly, one per visible run
};
/// How lines are drawn whose strength is little above the threshold.
enum class SvgFading {
    opacity,  ///< pale: a color between theirs and the background's; transparent without a background
    width,    ///< thin
    none      ///< like the others
};

struct SvgOptions {
    SvgForm form = SvgForm::lines;
    SvgFading fading = SvgFading::opacity;
    float tolerance = 0.1f;  ///< maximum deviation of simplified paths in pixels; 0 keeps all points
    float shortest = 1.5f;   ///< pixels; shorter visible runs are left out
    /// Whether center lines are curves through their points, which stay smooth when enlarged. They deviate from the
    /// polyline by at most half a pixel.
    bool curves = false;
    bool background = true;         ///< adds a layer with a rectangle of the background color, if there is one
    double frames_per_second = 30;  ///< for more than one frame
    std::string title = "Drawing";
};

/// The size of what was written.
struct SvgSummary {
    std::size_t paths = 0, points = 0;
    double length = 0;  ///< of all visible runs, in pixels
};

/// A named layer of strokes of one color.
struct SvgLayer {
    std::string name;
    Color color{0, 0, 0};
    float opacity = 1;
    std::span<const Stroke> strokes;
};
/// Writes layers of strokes as an SVG file, the first at the bottom, over a background if there is one. Paths of a
/// layer are ordered so that a plotter's pen moves little between them. Throws as write_drawing_svg does.
SvgSummary write_layers_svg(const std::filesystem::path& path, int width, int height,
                            const std::optional<Color>& background, std::span<const SvgLayer> layers,
                            const SvgOptions& options = {});

/// Writes drawings of one size as an SVG file with a layer per line type, named after it, without hidden lines.
/// Paths of a layer are ordered so that a plotter's pen moves little between them. Several drawings become the
/// frames of a looping animation, a layer each; programs that do not play it show the first. With `inks`, strokes of a
/// part with its own ink are a layer of their own, as "contours: torso". Throws UsageError if
/// there is no drawing, sizes differ or an option is out of range, DataError if the file cannot be written.
SvgSummary write_drawing_svg(const std::filesystem::path& path, std::span<const Drawing> frames,
                             const DrawingStyle& style, const SvgOptions& options = {}, const PartInks& inks = {});

}  // namespace exemplar
