#pragma once

#include "gpu/curvature/normals.h"
#include "gpu/curvature/surface.h"
#include "gpu/runtime/buffer.h"
#include "gpu/runtime/kernel.h"
#include "gpu/runtime/stream.h"

namespace exemplar {

/// Re-estimates normals, principal curvatures and directions, and their derivatives, of a deforming surface on the
/// device, as estimate_curvature() does (Rusinkiewicz 2004). In single precision: faces lower than 1e-6 of their
/// longest edge are left out where the reference takes 1e-7. All attributes stay on the device, a vec4 per vertex each.
class GpuCurvature {
  public:
    /// `surface` must live as long as this.
    explicit GpuCurvature(const GpuSurface& surface, bool derivatives = true);

    /// Curvature of `vertices`, a vec4 per vertex: three dispatches, without derivatives two. Throws UsageError if they
    /// are not of the surface.
    void record(Stream& stream, const Buffer& vertices);
    /// As GpuNormals has them.
    const Buffer& normals() const { return normals_.normals(); }
    /// The unit principal direction e1 and its curvature k1 >= k2, in 1 / mesh units.
    const Buffer& first() const { return first_; }
    /// The same of the second; e1 x e2 is the normal.
    const Buffer& second() const { return second_; }
    /// C111, C112, C122, C222 in (e1, e2), in 1 / squared mesh units; empty unless asked for.
    const Buffer& derivative() const { return derivative_; }

  private:
    const GpuSurface& surface_;
    GpuNormals normals_;
    Kernel curvature_kernel_, derivative_kernel_;
    Buffer first_, second_, derivative_;
};

}  // namespace exemplar
