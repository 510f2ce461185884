#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "gpu/imaging/surface_painter.h"
#include "host/lines/extraction/lines.h"
#include "host/lines/strokes/style.h"
#include "host/mesh/labels.h"

namespace exemplar {

/// The curvature that colors and lines use: measured on every frame, learned, or both side by side.
enum class ShownCurvature { estimated, learned, both };

/// Everything that decides how a surface looks, except the camera.
struct ViewSettings {
    SurfacePaint paint = SurfacePaint::plain;
    SurfaceLight light = SurfaceLight::smooth;
    Color plain{226, 224, 218};
    Color background{250, 250, 248};
    /// The curvature of the strongest color, times the feature size.
    float curvature_range = 0.25f;
    ShownCurvature source = ShownCurvature::estimated;
    std::array<bool, k_line_types.size()> lines{true, true};  ///< which are shown, in the order of k_line_types
    DrawingStyle style = load_style("ink");                   ///< of lines; its surface and background are above
    std::uint64_t style_version = 1;                          ///< increment it when the style is changed

    bool shows_lines() const { return std::ranges::find(lines, true) != lines.end(); }
    bool shows(LineType type) const {
        const auto shown = shown_lines();
        return std::ranges::find(shown, type) != shown.end();
    }
    std::vector<LineType> shown_lines() const {
        std::vector<LineType> types;
        for (std::size_t i = 0; i < lines.size(); ++i)
            if (lines[i]) types.push_back(k_line_types[i]);
        return types;
    }
    /// All lines need it, as strokes are thinner where the surface bends.
    bool needs_curvature() const { return paints_curvature(paint) || shows_lines(); }
    /// Sets a style, with its surface and background.
    void set_style(const DrawingStyle& next);
};

}  // namespace exemplar
