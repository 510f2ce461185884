#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/exemplar/lines/drawn_animation.h"
#include "apps/exemplar/lines/lines_job.h"
#include "gpu/lines/extraction.h"
#include "gpu/runtime/device/device.h"
#include "host/imaging/image.h"
#include "host/lines/extraction/face_types.h"

namespace exemplar {

/// Draws frames of a source on the device, one after the other.
class FrameDrawer {
  public:
    FrameDrawer(const LinesJob& job, LinesSource& source, const StrokeView& view);

    /// By learned curvature if there is a model, else by measured.
    Image draw(std::size_t frame);
    /// Of a source with a model, measured curvature is what the model was trained to predict.
    Image draw(std::size_t frame, CurvatureSource from);

    /// The mean over all pictures but the first, each against the one before.
    LineFlicker flicker() const;

    /// The types of lines that faces carry in the last picture.
    FaceTypes face_types() const;
    /// And as seen from another place.
    FaceTypes face_types_from(const Vec3& eye);

    const std::string& device_name() const { return device_.info().name; }

  private:
    LinesSource& source_;
    Device device_;
    DrawnAnimation drawn_;
    Stream stream_;
    LinePicture picture_;
    std::vector<LineFlicker> flicker_;
    std::optional<GpuLineExtraction> elsewhere_;  // made when it is first asked for
};

}  // namespace exemplar
