#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>

#include "apps/viewer/scene/view_settings.h"
#include "apps/viewer/window/viewer_state.h"

namespace exemplar {

/// What the command line asks for.
struct ViewerOptions {
    std::filesystem::path file, model, hatching, out;
    std::filesystem::path hatched_still;  ///< to write without a window, instead of frames; empty: none
    std::string device, clip;
    ViewSize size{1280, 720};
    std::size_t frames = 0;                  ///< to draw before it ends; 0: until the window is closed
    std::optional<std::size_t> first_frame;  ///< playback stands there; none: it plays from the start
    bool headless = false, quiet = false, plain_window = false;
    std::string style;  ///< built in, or a file; empty: ink on a shaded surface
    std::optional<std::vector<LineType>> lines;
    std::optional<SurfacePaint> paint;
    std::optional<SurfaceLight> light;
    std::optional<ShownCurvature> source;
    std::optional<ViewSide> side;
    bool parallel = false;
    std::optional<std::size_t> losing_frame;  ///< tests: the device counts as lost at this frame
};

/// Opens what the options name, in a view of that size. Throws an Error if anything is wrong.
void open_files(ViewerState& state, const ViewerOptions& options, ViewSize view);
/// Lets settings be as the options have them.
void apply_options(ViewerState& state, const ViewerOptions& options, ViewSize view);

/// Throws DeviceError if the validation layer has said anything.
void require_silence(const ValidationLog& log);

/// Draws frames to files, or only draws them if there is no folder. Returns how many.
void run_headless(const ViewerOptions& options);
/// Opens a window and stays until it is closed.
void run_window(const ViewerOptions& options);

}  // namespace exemplar
