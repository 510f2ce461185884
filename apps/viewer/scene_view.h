#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "apps/viewer/view_settings.h"
#include "gpu/imaging/canvas.h"
#include "gpu/lines/device_style.h"
#include "gpu/lines/line_renderer.h"
#include "gpu/window/surface_painter.h"

namespace exemplar {

/// A surface at a moment, and what is known of it beside.
struct SceneMoment {
    GpuCurvedSurface surface;
    const Buffer* face_colors;  ///< null without labels
    float feature_size = 0;
};

/// Where a scene is seen from.
struct ViewCamera {
    Camera camera;
    float distance;  ///< at which strokes have the widths of their style, in mesh units
};

/// One picture of a scene: with lines by LineRenderer, without by SurfacePainter, which knows more ways to paint.
class SceneView {
  public:
    /// `surface` must live as long. `colors` has one per face, or is empty.
    SceneView(const GpuSurface& surface, const GpuLineSurface& lines, std::span<const Color> colors);

    void record(Stream& stream, const SceneMoment& moment, const ViewCamera& camera, VkExtent2D extent,
                const ViewSettings& settings);
    /// Has the picture after end().
    Canvas& canvas() { return with_lines_ ? lines_->canvas() : picture_; }

  private:
    void record_lines(Stream& stream, const SceneMoment& moment, const ViewCamera& camera, VkExtent2D extent,
                      const ViewSettings& settings);
    void record_surface(Stream& stream, const SceneMoment& moment, const ViewCamera& camera, VkExtent2D extent,
                        const ViewSettings& settings);
    void follow_style(const ViewSettings& settings);
    const GpuSurface& surface_;
    const GpuLineSurface& line_surface_;
    std::vector<Color> colors_;
    Canvas picture_;
    // Made when they are first asked for: both are many kernels.
    std::optional<SurfacePainter> painter_;
    std::optional<LineRenderer> lines_;
    DeviceStyle style_;
    std::uint64_t style_version_ = 0;
    bool with_lines_ = false;
};

}  // namespace exemplar
