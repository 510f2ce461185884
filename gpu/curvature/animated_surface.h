#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "gpu/curvature/learned/learned_curvature.h"
#include "gpu/curvature/surface/curvature.h"
#include "gpu/curvature/surface/curved_surface.h"
#include "gpu/curvature/surface/normals.h"
#include "gpu/curvature/surface/poser.h"
#include "gpu/curvature/surface/surface.h"
#include "gpu/runtime/record/stream.h"
#include "host/animation/animation.h"
#include "host/curvature/model/model.h"

namespace exemplar {

/// Source of the curvature of a frame: none is computed, estimated from the posed mesh, or predicted by a model.
enum class CurvatureSource { none, estimated, learned };

/// An animated surface on the device: vertices, normals and curvature of a pose or a frame of a mesh sequence.
class GpuAnimatedSurface {
  public:
    /// `surface`: a shape of the animation (see first_shape) rather than the bind pose, which may have another
    /// scale; it must live as long as this. `options`: for estimated curvature. Throws UsageError and
    /// DeviceLimitError as its parts do.
    GpuAnimatedSurface(const GpuSurface& surface, const Animation& animation, const CurvatureOptions& options);

    /// Sets the model of learned curvature; it must fit the animation (require_compatible). No recorded work that uses
    /// an earlier model may still await submission. Throws ModelError and DeviceLimitError as GpuLearnedCurvature does.
    void set_model(const CurvatureModel& model);

    /// Records the vertices of a shape of the animation, their normals and their curvature. Throws UsageError if the
    /// shape is not of the animation, or learned curvature is requested without a model.
    void record(Stream& stream, const SurfaceShape& shape, CurvatureSource source);
    /// Records normals and curvature from another source for the shape of the last call.
    void record_again(Stream& stream, CurvatureSource source);

    /// Returns the buffers of the last recorded frame.
    GpuCurvedSurface snapshot() const;

  private:
    const Buffer& normals() const;
    const GpuSurface& surface_;
    Rig rig_;
    CurvatureOptions options_;
    GpuPoser poser_;
    GpuNormals normals_;
    std::optional<GpuCurvature> estimated_;  // made at its first use
    std::optional<GpuLearnedCurvature> learned_;
    CurvatureSource source_ = CurvatureSource::none;
    // The shape of the last call.
    std::optional<Pose> pose_;
    std::vector<Vec3> frame_;
};

}  // namespace exemplar
