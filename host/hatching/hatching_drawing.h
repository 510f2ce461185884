#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "host/hatching/fields/hatch_stroke.h"
#include "host/hatching/fields/hatching_fields.h"
#include "host/hatching/style/hatching_style.h"
#include "host/imaging/image.h"
#include "host/lines/drawing.h"
#include "host/lines/drawing_svg.h"
#include "host/lines/part_inks.h"
#include "host/lines/strokes/strokes.h"

namespace exemplar {

/// The inks of the parts in a hatched view.
struct HatchingInks {
    PartInks strokes, curves;         ///< of hatching strokes and feature curves; empty: all are black
    std::vector<std::uint32_t> face;  ///< per pixel, row by row: the face that is seen there, or k_no_face
};

/// The hatching of a view: strokes, with feature curves drawn over them.
struct HatchedDrawing {
    int width = 0, height = 0;  ///< pixels
    std::vector<HatchStroke> strokes;
    Drawing curves;  ///< may be without layers
    HatchingInks inks{};
};

/// Tapers the widths of strokes to points at both ends: along a quarter of an ellipse over `taper` pixels (see
/// stroke_taper), but over no more than a quarter of the stroke.
void taper_strokes(std::span<HatchStroke> strokes, float taper);

/// Returns how feature curves are drawn beside hatching: in black ink; if the drawing that a style was learned from has
/// outlines, all with a pen of their width.
DrawingStyle curve_look(const HatchingStyle& style);

/// Returns the strokes of a layer as strokes of line drawings; their darkness becomes opacity.
std::vector<Stroke> layer_strokes(std::span<const HatchStroke> strokes, std::size_t layer);

/// Writes the layers "hatching" and "cross_hatching", and one layer per type of feature curve; strokes of a part with
/// its own ink are a layer of their own, as "hatching: torso". Throws as write_drawing_svg.
SvgSummary write_hatching_svg(const std::filesystem::path& path, const HatchedDrawing& drawing,
                              const DrawingStyle& style, const SvgOptions& options = {});

/// Renders the drawing on white as an RGB image, `scale` (positive) times as large.
Image hatching_picture(const HatchedDrawing& drawing, const DrawingStyle& style, float scale = 1);

/// Returns the 1st and the 99th percentile of the values where `known` is not zero; two zeros if it is nowhere.
std::array<float, 2> property_range(std::span<const float> values, std::span<const std::uint8_t> known);
/// Renders a property for inspection where `known` is not zero: shades of one color, from light (values up to
/// range[0]) to dark (from range[1] on); white elsewhere.
Image property_picture(std::span<const float> values, std::span<const std::uint8_t> known, int width, int height,
                       const std::array<float, 2>& range);
/// Renders directions (radians) as hues where `known` is not zero: red along x, then green, then blue; white
/// elsewhere.
Image orientation_picture(std::span<const float> angles, std::span<const std::uint8_t> known, int width, int height);
/// Renders labels as flat colors; pixels with the label `none` are white.
Image label_picture(std::span<const std::uint8_t> labels, std::uint8_t none, int width, int height);

}  // namespace exemplar
