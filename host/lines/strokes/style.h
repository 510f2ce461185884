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
    float opacity = 1;  ///< in [0, 1]; multiplied by that of each point
    StrokeThickness thickness;
    std::string texture = "none";    ///< "none", a name of stroke_texture_names(), or the path of a PNG file
    std::optional<float> threshold;  ///< see set_threshold; none: that of LineThresholds
};

/// How the surface itself is shown in raster images.
enum class SurfaceShading {
    none,    ///< not at all: the background shows through (hidden lines stay hidden)
    paper,   ///< in one flat color
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
    /// Returns the thresholds for lines of a type.
    LineThresholds thresholds(LineType type) const;
};

/// Returns whether lines of a type have a threshold: all but contours and boundaries.
bool has_threshold(LineType type);
/// Sets the threshold of a type, in its unit (see LineThresholds) but for creases in DEGREES. Throws UsageError if
/// the type has none, or the value is negative, not finite or, for creases, above 180.
void set_threshold(LineThresholds& thresholds, LineType type, float value);

/// Returns the names of the built-in styles.
std::span<const std::string_view> builtin_style_names();
/// Returns a built-in style as the text of a style file. Throws UsageError for another name.
std::string_view builtin_style_text(std::string_view name);

/// Reads a style from JSON text (docs/lines.md); comments are allowed. `name` is its name in errors, and paths of
/// textures are relative to `folder`. Throws DataError, one line with the name, the place (line and column, or JSON
/// pointer) and a remedy, for bad JSON, unknown or repeated keys, wrong types, values out of range and missing
/// textures.
DrawingStyle parse_style(std::string_view text, const std::string& name, const std::filesystem::path& folder);
/// Loads the built-in style with that name, or else that file. Throws DataError as parse_style does, and if there is
/// neither.
DrawingStyle load_style(const std::string& name_or_path);

}  // namespace exemplar
