#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>

#include "apps/viewer/scene/view_settings.h"
#include "apps/viewer/scene/viewer_state.h"
#include "gpu/runtime/device/instance.h"

namespace exemplar {

/// Command-line options of the viewer.
struct ViewerOptions {
    std::filesystem::path file, model, hatching, out;
    bool label = false;                   ///< labels of the file, or of the meshes of the folder, are painted
    std::filesystem::path script;         ///< of painting, without a window; empty: none
    std::filesystem::path hatched_still;  ///< written without a window, instead of frames; empty: none
    std::string device, clip;
    ViewSize size{1280, 720};
    std::size_t frames = 0;                  ///< number of frames to draw; 0: until the window is closed
    std::optional<std::size_t> first_frame;  ///< paused at this frame; none: plays from the start
    bool headless = false, quiet = false, plain_window = false;
    std::string style;  ///< name of a built-in style, or a file; empty: ink on a shaded surface
    std::optional<std::vector<LineType>> lines;
    std::optional<SurfacePaint> paint;
    std::optional<SurfaceLight> light;
    std::optional<ShownCurvature> source;
    std::optional<ViewSide> side;
    bool parallel = false;
    // Tests: the device counts as lost after so many frames, or drawing fails.
    std::optional<std::size_t> losing_frame, failing_frame;
};

/// Opens the files that the options name, in a view of that size. Throws an Error if that fails.
void open_files(ViewerState& state, const ViewerOptions& options, ViewSize view);
/// Applies the options to the settings.
void apply_options(ViewerState& state, const ViewerOptions& options, ViewSize view);

/// Throws DeviceError if the validation layer has any messages.
void require_no_validation_messages(const ValidationLog& log);

/// Draws frames and writes them to files; only draws them if there is no output folder. Or draws and writes the
/// hatched still.
void run_headless(const ViewerOptions& options);
/// Opens a window and runs until it is closed.
void run_window(const ViewerOptions& options);

}  // namespace exemplar
