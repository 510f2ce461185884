#pragma once

#include <filesystem>

#include "apps/viewer/window/viewer_state.h"

namespace exemplar {

/// Writes the lines that a viewer shows as an SVG file of that size, found and hidden exactly, on the host; with
/// learned curvature where it shows that, twice side by side where it shows both. Throws DataError if the file cannot
/// be written, UsageError if no lines are shown.
void save_svg(const std::filesystem::path& path, const ViewerState& state, ViewSize size);

}  // namespace exemplar
