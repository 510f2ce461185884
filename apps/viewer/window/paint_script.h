#pragma once

#include <filesystem>

#include "apps/viewer/scene/frame_renderer.h"
#include "apps/viewer/scene/options.h"
#include "apps/viewer/scene/viewer_state.h"

namespace exemplar {

/// Paints labels by the commands of a file, a line each (docs/viewer.md): what a person does with mouse and keys.
/// Throws UsageError with file and line for a command that is not understood, or what the command throws.
void run_paint_script(const std::filesystem::path& path, ViewerState& state, FrameRenderer& renderer,
                      const ViewerOptions& options);

}  // namespace exemplar
