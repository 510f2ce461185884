#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

#include "host/mesh/labels.h"

namespace exemplar {

/// A line of an SVG, as it is drawn.
struct SvgStroke {
    std::vector<Eigen::Vector2d> points;  ///< at least two, in units of the page; curves are flattened
    bool closed = false;
    double width = 1;  ///< in units of the page
    Color color{};
    double opacity = 1;  ///< in (0, 1]
    int group = -1;      ///< index of the innermost named group; -1: none
};

/// A group with a name: a layer's label, or the group's id.
struct SvgGroup {
    std::string name;
    int outer = -1;  ///< index of the named group around it
};

/// The lines of an SVG. Units are those of the viewBox, whose upper left corner is (0, 0).
struct SvgPicture {
    double width = 0, height = 0;  ///< of the page: positive
    std::vector<SvgStroke> strokes;
    std::vector<SvgGroup> groups;
};

/// Returns whether a file is an SVG, by how it begins.
bool is_svg(std::string_view content);
/// Reads the stroked lines of an SVG: paths, lines, polygons, rectangles, circles and ellipses, with transforms,
/// widths, colors and opacity from attributes, styles and the classes of a style sheet. Fillings, pictures, text and
/// what is hidden are left out. Throws DataError, naming the file and the line, if it is no XML, if its size is
/// unknown, or if it has strokes with dashes or copies (`use`), and so on, which are not read.
SvgPicture read_svg(std::string_view content, const std::string& name);

}  // namespace exemplar
