#pragma once

#include <filesystem>

#include "apps/viewer/scene/viewer_state.h"

namespace exemplar {

/// Writes the lines that the viewer shows as an SVG file of that size, with exact hidden-line removal on the host.
/// Uses learned curvature, or draws both side by side, if the viewer does. Throws DataError if the file cannot be
/// written, UsageError if no lines are shown.
void save_svg(const std::filesystem::path& path, const ViewerState& state, ViewSize size);

}  // namespace exemplar
