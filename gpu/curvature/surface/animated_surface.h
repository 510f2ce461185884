#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "gpu/curvature/surface/curvature.h"
#include "gpu/curvature/surface/curved_surface.h"
#include "gpu/curvature/learned/learned_curvature.h"
#include "gpu/curvature/surface/normals.h"
#include "gpu/curvature/surface/poser.h"
#include "gpu/curvature/surface/surface.h"
#include "gpu/runtime/record/stream.h"
#include "host/animation/animation.h"
#include "host/curvature/model/model.h"

namespace exemplar {

/// Where the curvature of a moment comes from.
enum class CurvatureSource { none, estimated, learned };

/// A surface that moves, on the device: from a pose, or a frame of a mesh sequence, to vertices, normals and curvature.
class GpuAnimatedSurface {
  public:
    /// `surface` is a shape that the animation takes (see first_shape), as the space in which rigs bind their vertices
    /// may have another scale; it must live as long as this. `options`: of estimated curvature. Throws as its parts do:
    /// UsageError, DeviceLimitError.
    GpuAnimatedSurface(const GpuSurface& surface, const Animation& animation, const CurvatureOptions& options);

    /// Takes learned curvature from this model from now on; it must fit the animation (require_fit). No work that uses
    /// an earlier one may be recorded and not submitted. Throws ModelError and DeviceLimitError as GpuLearnedCurvature.
    void set_model(const CurvatureModel& model);
    bool has_model() const { return learned_.has_value(); }

    /// Records all that leads from a pose of the rig to curvature. Throws UsageError if the pose is not of the rig, or
    /// nothing has been learned that should be used.
    void record(Stream& stream, const Pose& pose, CurvatureSource source);
    /// The same of a frame of a mesh sequence, or of a mesh that does not move.
    void record(Stream& stream, std::span<const Vec3> vertices, CurvatureSource source);
    /// Records curvature from another source at the vertices of the last call.
    void record_again(Stream& stream, CurvatureSource source);

    const GpuSurface& surface() const { return surface_; }
    const Rig& rig() const { return rig_; }
    const Buffer& vertices() const { return poser_.vertices(); }
    const Buffer& normals() const;
    /// The buffers of what was recorded last.
    GpuCurvedSurface moment() const;

  private:
    void record_curvature(Stream& stream, CurvatureSource source);
    const GpuSurface& surface_;
    Rig rig_;
    CurvatureOptions options_;
    GpuPoser poser_;
    GpuNormals normals_;
    std::optional<GpuCurvature> estimated_;  // made when it is first asked for
    std::optional<GpuLearnedCurvature> learned_;
    CurvatureSource source_ = CurvatureSource::none;
    // Of the last call: a pose, or vertices.
    std::optional<Pose> pose_;
    std::vector<Vec3> frame_;
};

}  // namespace exemplar
