#pragma once

#include <cstddef>
#include <deque>
#include <optional>

#include "gpu/curvature/animated_surface.h"
#include "gpu/lines/cut_surface.h"
#include "gpu/lines/line_renderer.h"
#include "gpu/lines/line_surface.h"
#include "gpu/runtime/device/device.h"
#include "gpu/runtime/record/stream.h"
#include "host/animation/animation.h"
#include "host/curvature/model/model.h"
#include "host/curvature/state/samples.h"
#include "host/lines/extraction/split_surface.h"

namespace exemplar {

/// Renders an animated surface in lines: owns the surface, its curvature, and the renderers of its views.
class AnimationRenderer {
  public:
    /// `estimated`: how curvature is estimated. `model`: of learned curvature, null: none; it must fit the animation
    /// (require_compatible) and need not outlive this. `crease_angle`: of the edges that the first shape is cut open
    /// along, see mark_sharp_edges. The animation must outlive this. Throws as GpuSurface, GpuLineSurface and
    /// GpuAnimatedSurface.
    AnimationRenderer(Device& device, const Animation& animation, const CurvatureOptions& estimated,
                      const CurvatureModel* model = nullptr, float crease_angle = LineThresholds{}.crease_angle);

    /// Records the surface at a frame, or in any other shape (see GpuAnimatedSurface).
    void record(Stream& stream, FrameRef frame, CurvatureSource source);
    void record(Stream& stream, const SurfaceShape& shape, CurvatureSource source);
    /// Records curvature from another source for the shape of the last call.
    void record_again(Stream& stream, CurvatureSource source);
    /// Sets whether curvature is estimated on the parts that the surface is cut into, for lines with creases (see
    /// DrawableOptions::cut_curvature). At first it is estimated on the whole surface, as learned curvature always is.
    void set_cut_curvature(bool cut) { cut_curvature_ = cut; }
    /// Returns the surface that was recorded last.
    GpuCurvedSurface snapshot() const { return cut_ ? cut_->snapshot() : moving_.snapshot(); }

    const GpuLineSurface& line_surface() const { return line_surface_; }
    /// Returns the renderer of a view, which is made at its first use; views are numbered without gaps. Throws as
    /// LineRenderer.
    LineRenderer& view(std::size_t index = 0);

  private:
    struct FirstShape {
        TriangleMesh mesh;
        SharpEdges edges;
    };
    static FirstShape first_shape_of(const Animation& animation, float crease_angle);
    AnimationRenderer(Device& device, const Animation& animation, const CurvatureOptions& estimated,
                      const CurvatureModel* model, const FirstShape& first);
    bool estimates_parts(CurvatureSource source) const {
        return cut_ && cut_curvature_ && source == CurvatureSource::estimated;
    }
    void record_cut(Stream& stream, CurvatureSource source);
    const Animation& animation_;
    GpuSurface surface_;
    std::optional<GpuCutSurface> cut_;  // if the surface has sharp edges
    GpuLineSurface line_surface_;
    GpuAnimatedSurface moving_;
    std::deque<LineRenderer> views_;
    bool cut_curvature_ = false;
};

}  // namespace exemplar
