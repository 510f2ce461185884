#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "apps/viewer/scene/view_settings.h"
#include "gpu/lines/device_style.h"
#include "gpu/lines/line_renderer.h"

namespace exemplar {

/// A surface at one frame, with its feature size.
struct SceneFrame {
    GpuCurvedSurface surface;
    float feature_size = 0;
};

/// The camera of a view.
struct ViewCamera {
    Camera camera;
    float distance;  ///< at which strokes have the widths of their style, in mesh units
};

/// One picture of a scene.
class SceneView {
  public:
    /// `surface` must outlive this. `colors` has one per face, or is empty.
    SceneView(const GpuLineSurface& surface, std::span<const Color> colors);

    void record(Stream& stream, const SceneFrame& moment, const ViewCamera& camera, VkExtent2D extent,
                const ViewSettings& settings);
    /// Holds the picture when the recorded work is done.
    Canvas& canvas() { return renderer_.canvas(); }

  private:
    void follow_style(const ViewSettings& settings);
    LineRenderer renderer_;
    DeviceStyle style_;
    std::uint64_t style_version_ = 0;
};

}  // namespace exemplar
