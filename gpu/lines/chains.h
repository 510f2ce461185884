#pragma once

#include "gpu/lines/extraction.h"
#include "gpu/lines/line_surface.h"
#include "gpu/runtime/record/buffer.h"
#include "gpu/runtime/kernels/kernel.h"
#include "gpu/runtime/record/stream.h"
#include "host/imaging/camera.h"

namespace exemplar {

/// Joins segments to chains on the device, as chain_segments does, and lays their points out one after the other: by
/// jumps that double (Wyllie 1979), so that the result does not depend on the device's scheduling.
class GpuChains {
  public:
    /// `lines` must live as long as this.
    explicit GpuChains(GpuLineExtraction& lines);

    /// Chains of the segments that `lines` has found on `vertices`, as seen in a picture of this size. 28 dispatches,
    /// of which the jumps do nothing once they are as long as there are segments.
    void record(Stream& stream, const Buffer& vertices, const Camera& camera, int width, int height);

    /// shared::LinePoint each, in the order of chains' first segments; their number is in GpuLineExtraction::counts().
    const Buffer& points() const { return points_; }
    const GpuLineExtraction& lines() const { return lines_; }

  private:
    GpuLineExtraction& lines_;
    Kernel link_kernel_, node_kernel_, jump_kernel_, rank_kernel_, scan_kernel_, point_kernel_;
    std::size_t rounds_;
    Buffer picture_ends_, links_, nodes_, other_nodes_, ranks_, point_counts_, point_groups_, points_;
};

}  // namespace exemplar
