#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "host/lines/extraction/lines.h"
#include "host/lines/strokes/strokes.h"
#include "host/mesh/labels.h"

namespace exemplar {

/// How lines of one type are drawn.
struct LineStyle {
    Color color{0, 0, 0};
    float opacity = 1;  ///< in [0, 1]; multiplied with that of each point
    StrokeThickness thickness;
    std::string texture = "none";    ///< "none", a name of stroke_texture_names(), or the path of a PNG file
    std::optional<float> threshold;  ///< see set_threshold; none: that of LineThresholds
};

/// What is seen of the surface itself in pictures made of pixels.
enum class SurfaceShading {
    none,    ///< nothing: the background shows through (hidden lines stay hidden)
    paper,   ///< one even color
    shaded,  ///< lit from the eye
    toon     ///< lit in two steps
};

/// The look of a line drawing.
struct DrawingStyle {
    std::string name;                 ///< built-in name or path of the file
    std::optional<Color> background;  ///< none: transparent
    SurfaceShading shading = SurfaceShading::none;
    Color surface{255, 255, 255};
    float fade = LineThresholds{}.fade;
    std::array<LineStyle, k_line_types.size()> lines;

    const LineStyle& of(LineType type) const { return lines[static_cast<std::size_t>(type)]; }
    LineStyle& of(LineType type) { return lines[static_cast<std::size_t>(type)]; }
    /// The thresholds that lines of a type are found with.
    LineThresholds thresholds(LineType type) const;
};

/// Whether lines of the type have to pass a threshold: all but contours and boundaries.
bool has_threshold(LineType type);
/// Sets the threshold of a type, in its unit (see LineThresholds), that of creases in DEGREES. Throws UsageError if the
/// type has none or the value is negative, not finite, or for creases above 180.
void set_threshold(LineThresholds& thresholds, LineType type, float value);

/// Names of the styles that need no file.
std::span<const std::string_view> builtin_style_names();
/// A built-in style as the text of a style file; throws UsageError naming the styles there are for another name.
std::string_view builtin_style_text(std::string_view name);

/// Reads a style from JSON text (docs/lines.md); comments are allowed. `name` is what errors call it, paths of textures
/// are relative to `folder`. Throws DataError in one line with name, place (line and column, or JSON pointer) and mend
/// for anything that is no style: bad JSON, unknown or repeated keys, wrong types, values out of range, missing
/// textures.
DrawingStyle parse_style(std::string_view text, const std::string& name, const std::filesystem::path& folder);
/// The style that is built in by that name, or else in that file. Throws DataError as parse_style, and if there is
/// neither.
DrawingStyle load_style(const std::string& name_or_path);

}  // namespace exemplar
