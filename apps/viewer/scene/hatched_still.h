#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "apps/viewer/controls/orbit_camera.h"
#include "host/hatching/hatching_drawing.h"
#include "host/hatching/style/hatching_style.h"
#include "host/hatching/features/hatching_view.h"

namespace exemplar {

class ViewerState;

/// All that a hatched picture of what a viewer shows is made of.
struct HatchedStill {
    std::shared_ptr<const HatchingStyle> hatching;
    TriangleMesh mesh;
    HatchingView view;
    float unit_depth = 1;          ///< where feature curves have the widths of their style
    std::vector<LineType> curves;  ///< that are drawn over it
    DrawingStyle look;             ///< of these
    std::string title, device;
};

/// What is shown now, in a picture of that size: the lines that are shown, and the usual light. Lines too pale for
/// white paper are black. Throws UsageError if no style is open, or nothing to draw.
HatchedStill hatched_still(const ViewerState& state, ViewSize size, const std::string& device);

/// Draws it on a device of its own. `step` is told what comes next (a present participle); what it throws ends it.
/// Throws as measure_surface, PixelFeatures, and hatch_view; DeviceError if the validation layer complains.
HatchedDrawing draw_still(const HatchedStill& still, const std::function<void(const char*)>& step);
/// Throws UsageError unless it ends in .svg or .png.
void require_still_name(const std::filesystem::path& path);
/// Writes it, as .svg or .png by its name. Throws as require_still_name, DataError if it cannot be written.
void write_still(const std::filesystem::path& path, const HatchedStill& still, const HatchedDrawing& drawing);

}  // namespace exemplar
