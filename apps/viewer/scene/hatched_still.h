#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "apps/viewer/controls/orbit_camera.h"
#include "host/hatching/features/hatching_view.h"
#include "host/hatching/hatching_drawing.h"
#include "host/hatching/style/hatching_style.h"

namespace exemplar {

class ViewerState;

/// Input of a hatched picture of the viewer's scene.
struct HatchedStill {
    std::shared_ptr<const HatchingStyle> hatching;
    TriangleMesh mesh;
    HatchingView view;
    float unit_depth = 1;          ///< depth at which feature curves have the widths of their style
    std::vector<LineType> curves;  ///< drawn over the hatching
    DrawingStyle look;             ///< of the curves
    std::string title, device;
};

/// Returns the input for the current view in a picture of that size, with the shown lines and the usual light. Lines
/// too pale for white paper become black. Throws UsageError if no style is open or there is nothing to draw.
HatchedStill hatched_still(const ViewerState& state, ViewSize size, const std::string& device);

/// Draws on a device of its own. Calls `step` with the name of each step (a present participle); an exception of
/// `step` ends the work. Throws as measure_surface, PixelFeatures, and hatch_view; DeviceError if the validation
/// layer has messages.
HatchedDrawing draw_still(const HatchedStill& still, const std::function<void(const char*)>& step);
/// Throws UsageError unless the name ends in .svg or .png.
void require_still_name(const std::filesystem::path& path);
/// Writes the drawing, as .svg or .png by its name. Throws as require_still_name, DataError if it cannot be written.
void write_still(const std::filesystem::path& path, const HatchedStill& still, const HatchedDrawing& drawing);

}  // namespace exemplar
