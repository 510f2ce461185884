#pragma once

#include <Eigen/Core>
#include <string_view>
#include <vector>

namespace exemplar {

/// A line through points.
struct Polyline {
    std::vector<Eigen::Vector2d> points;
    bool closed = false;  ///< the last point is joined to the first, which it does not repeat
};

/// Returns the lines of an SVG path ("d"), curves flattened to within about `tolerance` (but to at most 64 pieces
/// each). Throws UsageError, naming the place in the text, if it is not valid or has numbers beyond a billion.
std::vector<Polyline> flattened_path(std::string_view data, double tolerance);

/// Reads the numbers of a text, separated by spaces or commas. Throws UsageError if there is something else.
std::vector<double> svg_numbers(std::string_view text);

}  // namespace exemplar
