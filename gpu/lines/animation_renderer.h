#pragma once

#include <cstddef>
#include <deque>
#include <optional>

#include "gpu/curvature/animated_surface.h"
#include "gpu/lines/line_renderer.h"
#include "gpu/lines/line_surface.h"
#include "gpu/runtime/device/device.h"
#include "gpu/runtime/record/stream.h"
#include "host/animation/animation.h"
#include "host/curvature/model/model.h"
#include "host/curvature/state/samples.h"

namespace exemplar {

/// Renders an animated surface in lines: owns the surface, its curvature, and the renderers of its views.
class AnimationRenderer {
  public:
    /// `estimated`, `model`: see set_curvature. The animation must outlive this. Throws as GpuSurface, GpuLineSurface
    /// and set_curvature.
    AnimationRenderer(Device& device, const Animation& animation, const CurvatureOptions& estimated,
                      const CurvatureModel* model = nullptr);

    /// Sets how curvature is estimated, and the model of learned curvature; null: none. The model must fit the
    /// animation (require_compatible) and need not outlive this. No recorded work may still await submission. Throws as
    /// GpuAnimatedSurface.
    void set_curvature(const CurvatureOptions& estimated, const CurvatureModel* model);

    /// Records the surface at a frame, or in any other shape (see GpuAnimatedSurface).
    void record(Stream& stream, FrameRef frame, CurvatureSource source);
    void record(Stream& stream, const SurfaceShape& shape, CurvatureSource source);
    /// Records curvature from another source for the shape of the last call.
    void record_again(Stream& stream, CurvatureSource source) { moving_->record_again(stream, source); }
    /// Returns the surface that was recorded last.
    GpuCurvedSurface snapshot() const { return moving_->snapshot(); }

    const GpuLineSurface& line_surface() const { return line_surface_; }
    /// Returns the renderer of a view, which is made at its first use; views are numbered without gaps. Throws as
    /// LineRenderer.
    LineRenderer& view(std::size_t index = 0);

  private:
    const Animation& animation_;
    GpuSurface surface_;
    GpuLineSurface line_surface_;
    std::optional<GpuAnimatedSurface> moving_;
    std::deque<LineRenderer> views_;
};

}  // namespace exemplar
