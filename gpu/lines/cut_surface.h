#pragma once

#include <optional>
#include <span>

#include "gpu/curvature/surface/curvature.h"
#include "gpu/curvature/surface/curved_surface.h"
#include "gpu/curvature/surface/normals.h"
#include "gpu/curvature/surface/surface.h"
#include "gpu/runtime/kernels/kernel.h"
#include "gpu/runtime/record/buffer.h"
#include "gpu/runtime/record/stream.h"
#include "host/lines/extraction/split_surface.h"

namespace exemplar {

/// A deforming surface, cut open along its sharp edges to draw lines of it. Normals are those of its smooth parts.
/// Curvature is that of the whole surface, or of its parts as well (DrawableSurface is the reference of both).
class GpuCutSurface {
  public:
    /// `whole`: at rest. `split`: of its faces. `options`: of the curvature of the parts. Throws as GpuSurface.
    GpuCutSurface(const GpuSurface& whole, const SplitSurface& split, const CurvatureOptions& options);
    GpuCutSurface(const GpuCutSurface&) = delete;
    GpuCutSurface& operator=(const GpuCutSurface&) = delete;

    const GpuSurface& surface() const { return surface_; }
    /// Records the vertices of a shape, their normals and their curvature, which is that of the whole surface.
    void record(Stream& stream, const GpuCurvedSurface& whole);
    /// Records vertices and normals of a shape, and curvature as it is estimated on the parts. Throws as GpuCurvature.
    void record_parts(Stream& stream, const GpuCurvedSurface& whole);
    /// Returns the buffers of the last recorded shape.
    GpuCurvedSurface snapshot() const { return *last_; }

  private:
    const Buffer& gather(Stream& stream, const Buffer& whole, Buffer& cut);
    GpuSurface surface_;
    CurvatureOptions options_;
    Kernel gather_kernel_;
    GpuNormals normals_;
    std::optional<GpuCurvature> parts_;  // made at its first use, as the buffers
    Buffer source_;
    Buffer vertices_, first_, second_, derivative_;
    std::optional<GpuCurvedSurface> last_;
};

}  // namespace exemplar
