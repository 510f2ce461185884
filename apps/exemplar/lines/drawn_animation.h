#pragma once

#include <span>

#include "gpu/curvature/animated_surface.h"
#include "gpu/lines/line_renderer.h"
#include "gpu/runtime/device/device.h"
#include "gpu/runtime/record/stream.h"
#include "host/animation/animation.h"
#include "host/curvature/state/samples.h"

namespace exemplar {

/// An animation on the device, and its line renderer.
class DrawnAnimation {
  public:
    /// `measured`: how to estimate curvature that is not learned. The animation must outlive this. Throws as
    /// GpuAnimatedSurface and LineRenderer.
    DrawnAnimation(Device& device, const Animation& animation, const CurvatureOptions& measured)
        : animation_(animation),
          surface_(device, first_shape(animation)),
          line_surface_(surface_),
          moving_(surface_, animation, measured),
          renderer_(device, line_surface_) {}

    void set_model(const CurvatureModel& model) { moving_.set_model(model); }
    /// Records the surface at a frame, with its curvature.
    void record(Stream& stream, FrameRef frame, CurvatureSource from) {
        const Clip& clip = animation_.clips[frame.clip];
        if (clip.poses.empty())
            moving_.record(stream, clip.frames[frame.frame], from);
        else
            moving_.record(stream, clip.poses[frame.frame], from);
    }
    /// The surface that was recorded last.
    GpuCurvedSurface snapshot() const { return moving_.snapshot(); }
    const GpuLineSurface& line_surface() const { return line_surface_; }
    LineRenderer& renderer() { return renderer_; }
    const LineRenderer& renderer() const { return renderer_; }

  private:
    const Animation& animation_;
    GpuSurface surface_;
    GpuLineSurface line_surface_;
    GpuAnimatedSurface moving_;
    LineRenderer renderer_;
};

}  // namespace exemplar
