#pragma once

#include <cstddef>
#include <deque>

#include "gpu/curvature/animated_surface.h"
#include "gpu/lines/cut_animation.h"
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
    /// `estimated`: how curvature is estimated. `model`: of learned curvature, null: none; it must fit the animation
    /// (require_compatible) and need not outlive this. `crease_angle`: see mark_sharp_edges. `cut`: whether the surface
    /// is cut open along sharp edges, normals and curvature; with a model, which knows it as a whole, it is not. The
    /// animation must outlive this. Throws as GpuSurface, GpuLineSurface and GpuAnimatedSurface.
    AnimationRenderer(Device& device, const Animation& animation, const CurvatureOptions& estimated,
                      const CurvatureModel* model = nullptr, float crease_angle = LineThresholds{}.crease_angle,
                      bool cut = true);

    /// Records the surface at a frame, or in any other shape (see GpuAnimatedSurface).
    void record(Stream& stream, FrameRef frame, CurvatureSource source);
    void record(Stream& stream, const SurfaceShape& shape, CurvatureSource source) {
        moving_.record(stream, cut_.shape(shape), source);
    }
    /// Records curvature from another source for the shape of the last call.
    void record_again(Stream& stream, CurvatureSource source) { moving_.record_again(stream, source); }
    /// Returns the surface that was recorded last.
    GpuCurvedSurface snapshot() const { return moving_.snapshot(); }

    const GpuLineSurface& line_surface() const { return line_surface_; }
    /// Returns the renderer of a view, which is made at its first use; views are numbered without gaps. Throws as
    /// LineRenderer.
    LineRenderer& view(std::size_t index = 0);

  private:
    const Animation& animation_;
    CutAnimation cut_;
    GpuSurface surface_;
    GpuLineSurface line_surface_;
    GpuAnimatedSurface moving_;
    std::deque<LineRenderer> views_;
};

}  // namespace exemplar
