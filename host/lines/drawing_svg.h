#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "host/lines/drawing.h"
#include "host/lines/strokes/style.h"

namespace exemplar {

/// How strokes become paths.
enum class SvgForm {
    lines,    ///< center lines with a stroke width, cut where it changes: what plotters and editors of lines want
    outlines  ///< filled shapes, one a visible run, whose width changes smoothly
};
/// What becomes of lines that are barely strong enough.
enum class SvgFading {
    opacity,  ///< they are pale: of a color between theirs and the background's, or transparent without background
    width,    ///< they are thin
    none      ///< nothing
};

struct SvgOptions {
    SvgForm form = SvgForm::lines;
    SvgFading fading = SvgFading::opacity;
    float tolerance = 0.1f;  ///< pixels that simplified paths may be off; 0 keeps all points
    float shortest = 1.5f;   ///< pixels; visible runs that are shorter are left out
    /// Center lines are curves through their points, at most half a pixel from the straight ways, and stay smooth when
    /// they are enlarged.
    bool curves = false;
    bool background = true;         ///< a rectangle of the style's background, if it has one, in a layer of its own
    double frames_per_second = 30;  ///< of more than one frame
    std::string title = "Drawing";
};

/// What was written.
struct SvgSummary {
    std::size_t paths = 0, points = 0;
    double length = 0;  ///< of all visible runs, in pixels
};

/// Strokes of one color under a name.
struct SvgLayer {
    std::string name;
    Color color{0, 0, 0};
    float opacity = 1;
    std::span<const Stroke> strokes;
};
/// Writes layers of strokes as an SVG file, the first at the bottom, over a background if there is one. Paths of a
/// layer stand in an order that keeps a pen's ways between them short. Throws as write_drawing_svg.
SvgSummary write_layers_svg(const std::filesystem::path& path, int width, int height,
                            const std::optional<Color>& background, std::span<const SvgLayer> layers,
                            const SvgOptions& options = {});

/// Writes drawings of one size as an SVG file with a layer per line type, named after it. Hidden lines are not in it.
/// Paths of a layer stand in an order that keeps a pen's ways between them short. More than one drawing are the frames
/// of an animation that repeats, a layer each; programs that do not play it show the first. Throws UsageError if there
/// is no drawing or sizes differ, DataError if the file cannot be written.
SvgSummary write_drawing_svg(const std::filesystem::path& path, std::span<const Drawing> frames,
                             const DrawingStyle& style, const SvgOptions& options = {});

}  // namespace exemplar
