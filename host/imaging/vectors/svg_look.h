#pragma once

#include <Eigen/Geometry>
#include <map>
#include <string>
#include <string_view>

#include "host/mesh/labels.h"

namespace exemplar {

/// Properties of an element, as attributes, styles and style sheets declare them: {"stroke": "#000"}.
using SvgDeclarations = std::map<std::string, std::string, std::less<>>;
/// Adds the declarations of a style ("stroke:#000;stroke-width:2"); later ones replace earlier ones.
void add_svg_style(std::string_view style, SvgDeclarations& declarations);
/// Returns the declarations of the classes in a style sheet, by their names; other selectors are left out.
std::map<std::string, SvgDeclarations, std::less<>> svg_classes(std::string_view sheet);

/// How the lines of an element are drawn.
struct SvgLook {
    bool stroked = false, shown = true, visible = true, dashed = false;
    Color color{}, current{};  ///< of lines; what "currentColor" names
    double width = 1;          ///< in the element's units
    double stroke_opacity = 1;
    double opacity = 1;  ///< product of that of all groups
    Eigen::Affine2d to_page = Eigen::Affine2d::Identity();
};
/// Returns how an element is drawn inside of another. Throws UsageError for values that are not read.
SvgLook svg_look_inside(const SvgLook& outer, const SvgDeclarations& declarations, std::string_view transform);

/// Returns a length in pixels of 1/96 inch: "2", "0.5mm". Throws UsageError if it is none; a share ("50%") is none.
double svg_length(std::string_view text);

}  // namespace exemplar
