#pragma once

#include "gpu/curvature/surface/surface.h"
#include "gpu/runtime/kernels/kernel.h"
#include "gpu/runtime/record/buffer.h"
#include "gpu/runtime/record/stream.h"

namespace exemplar {

/// Vertex normals on the device, weighted as vertex_normals() does (Max 1999).
class GpuNormals {
  public:
    /// `surface` must live as long as this.
    explicit GpuNormals(const GpuSurface& surface);

    /// Records the normals of `vertices`, a vec4 per vertex. Throws UsageError if they are not of the surface.
    void record(Stream& stream, const Buffer& vertices);
    /// A vec4 per vertex: unit normal, (0, 0, 1) without faces, and vertex area in squared mesh units, i.e. the
    /// parts of its faces that are nearest to it (Meyer et al. 2003).
    const Buffer& normals() const { return normals_; }

  private:
    const GpuSurface& surface_;
    Kernel kernel_;
    Buffer normals_;
};

}  // namespace exemplar
