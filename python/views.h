#pragma once

#include <pybind11/pybind11.h>

#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "host/lines/extraction/lines.h"
#include "host/lines/strokes/view_point.h"

namespace exemplar::python {

// Code that line drawings and hatchings share.

/// Arguments of the camera in Python.
struct ViewArguments {
    std::string view;
    pybind11::object eye, target, up;
    double field_of_view;
    std::pair<std::int64_t, std::int64_t> size;
};
/// Converts the arguments; throws UsageError naming a wrong one.
ViewPoint view_point_of(const ViewArguments& arguments);

/// The names of all types of lines.
std::vector<std::string> line_type_names();
/// Returns the line types of that name, or all for "all", in drawing order; throws UsageError for an unknown name.
std::vector<LineType> line_types_of(const std::vector<std::string>& words);

/// Returns the text that a function writes to the file whose path it is given.
std::string written_text(const std::function<void(const std::filesystem::path&)>& write);

constexpr const char* k_view_doc =
    "`view`: \"front\", \"back\", \"right\", \"left\", \"top\", \"bottom\", \"three-quarter\" or "
    "\"three-quarter-back\", as large as it\n"
    "fits; or `eye`, a point to see it from, and maybe `target`, a point to look at. `up`: what is up in the picture.\n"
    "`field_of_view`: degrees, vertical (0: parallel; up to 170). `size`: width and height in pixels (1 to 16384).\n";

}  // namespace exemplar::python
