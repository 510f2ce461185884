#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "apps/exemplar/lines/lines_job.h"
#include "gpu/lines/animation_renderer.h"
#include "gpu/lines/extraction.h"
#include "gpu/runtime/device/device.h"
#include "host/imaging/image.h"
#include "host/lines/extraction/face_types.h"
#include "host/lines/outline_check.h"

namespace exemplar {

/// Draws frames of a source on the device, one after the other.
class FrameDrawer {
  public:
    FrameDrawer(const LinesJob& job, LinesSource& source, const StrokeView& view);

    /// Draws a frame by learned curvature if there is a model, else by measured.
    Image draw(std::size_t frame);
    /// Draws a frame by that curvature. With a model, curvature is measured as in its training.
    Image draw(std::size_t frame, CurvatureSource from);

    /// Compares the ink of the last picture's lines with the outline of the surface in it.
    OutlineCheck check_outline_of(std::size_t frame);

    /// Returns the mean flicker over all pictures but the first, each compared with the one before.
    LineFlicker flicker() const;

    /// Returns the most segments of lines of one picture that the device had no room for.
    std::size_t dropped_segments() const { return dropped_; }

    /// Returns the line types of the faces in the last picture.
    FaceTypes face_types();
    /// The same as seen from another eye.
    FaceTypes face_types_from(const Vec3& eye);

    const std::string& device_name() const { return device_.info().name; }

  private:
    Image redraw(std::uint32_t families);
    LinesSource& source_;
    Device device_;
    AnimationRenderer renderer_;
    Stream stream_;
    LinePicture picture_;
    std::vector<LineFlicker> flicker_;
    std::size_t dropped_ = 0;
    std::optional<GpuLineExtraction> elsewhere_;  // made at first use
};

}  // namespace exemplar
