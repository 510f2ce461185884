#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "host/hatching/fields/hatch_stroke.h"
#include "host/hatching/fields/hatching_fields.h"
#include "host/imaging/image.h"
#include "host/lines/drawing.h"
#include "host/lines/drawing_svg.h"
#include "host/lines/strokes/strokes.h"

namespace exemplar {

/// A view hatched: strokes, and feature curves over them.
struct HatchedDrawing {
    int width = 0, height = 0;  ///< pixels
    std::vector<HatchStroke> strokes;
    Drawing curves;  ///< may be without layers
};

/// Makes strokes end in a point: a quarter of an ellipse over `taper` pixels at both ends, no longer than a quarter of
/// the stroke (see stroke_taper).
void taper_strokes(std::span<HatchStroke> strokes, float taper);

/// The strokes of a layer in the form of line drawings: gray is opacity.
std::vector<Stroke> layer_strokes(std::span<const HatchStroke> strokes, std::size_t layer);

/// Writes layers "hatching", "cross_hatching", and one for each type of feature curves. Throws as write_drawing_svg.
SvgSummary write_hatching_svg(const std::filesystem::path& path, const HatchedDrawing& drawing,
                              const DrawingStyle& style, const SvgOptions& options = {});

/// The drawing as a gray picture on white, `scale` times as large (a positive number).
Image hatching_picture(const HatchedDrawing& drawing, const DrawingStyle& style, float scale = 1);

/// A picture of a property for inspection: shades of one color from the least value (light) to the largest (dark) of
/// the pixels where `known` is not zero; white elsewhere. `range`: those two values, the 1st and 99th percentile.
Image property_picture(std::span<const float> values, std::span<const std::uint8_t> known, int width, int height,
                       std::array<float, 2>& range);
/// Directions as hues (red along x, then over green), where `known`.
Image orientation_picture(std::span<const float> angles, std::span<const std::uint8_t> known, int width, int height);
/// Labels as flat colors; those of `none` are white.
Image label_picture(std::span<const std::uint8_t> labels, std::uint8_t none, int width, int height);

}  // namespace exemplar
