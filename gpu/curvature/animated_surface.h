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
    bool has_model() const { return learned_.has_value(); }

    /// Records posing the rig, normals and curvature. Throws UsageError if the pose is not of the rig, or learned
    /// curvature is requested without a model.
    void record(Stream& stream, const Pose& pose, CurvatureSource source);
    /// Records the same for a frame of a mesh sequence, or for a static mesh.
    void record(Stream& stream, std::span<const Vec3> vertices, CurvatureSource source);
    /// Records curvature from another source for the vertices of the last call.
    void record_again(Stream& stream, CurvatureSource source);

    const GpuSurface& surface() const { return surface_; }
    const Rig& rig() const { return rig_; }
    const Buffer& vertices() const { return poser_.vertices(); }
    const Buffer& normals() const;
    /// Returns the buffers of the last recorded frame.
    GpuCurvedSurface snapshot() const;

  private:
    void record_curvature(Stream& stream, CurvatureSource source);
    const GpuSurface& surface_;
    Rig rig_;
    CurvatureOptions options_;
    GpuPoser poser_;
    GpuNormals normals_;
    std::optional<GpuCurvature> estimated_;  // made at its first use
    std::optional<GpuLearnedCurvature> learned_;
    CurvatureSource source_ = CurvatureSource::none;
    // The pose or the vertices of the last call.
    std::optional<Pose> pose_;
    std::vector<Vec3> frame_;
};

}  // namespace exemplar
