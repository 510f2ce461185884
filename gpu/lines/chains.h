#pragma once

#include "gpu/lines/extraction.h"
#include "gpu/lines/line_surface.h"
#include "gpu/runtime/kernels/kernel.h"
#include "gpu/runtime/record/buffer.h"
#include "gpu/runtime/record/stream.h"
#include "host/imaging/camera.h"

namespace exemplar {

/// Joins segments to chains on the device, as chain_segments does, and writes the points of each chain contiguously.
/// It uses pointer jumping (Wyllie 1979), so the result does not depend on the device's scheduling.
class GpuChains {
  public:
    /// `lines` must live as long as this.
    explicit GpuChains(GpuLineExtraction& lines);

    /// Records the chaining of the segments that `lines` found on `vertices`, in a picture of this size. Up to 17
    /// dispatches, five and one per quadrupling of lines().room(), rounded up to an even number; jumps that the number
    /// of segments does not need do nothing.
    void record(Stream& stream, const Buffer& vertices, const Camera& camera, int width, int height);

    /// A shared::LinePoint each, in the order of chains' first segments; GpuLineExtraction::counts() has their
    /// number.
    const Buffer& points() const { return points_; }
    /// Points of chains that begin before each segment, in its group of k_count_group segments; and before each group.
    const Buffer& point_counts() const { return point_counts_; }
    const Buffer& point_groups() const { return point_groups_; }
    const GpuLineExtraction& lines() const { return lines_; }

  private:
    GpuLineExtraction& lines_;
    Kernel link_kernel_, node_kernel_, jump_kernel_, rank_kernel_, scan_kernel_, point_kernel_;
    std::size_t rounds_;
    Buffer picture_ends_, links_, nodes_, other_nodes_, ranks_, point_counts_, point_groups_, points_;
};

}  // namespace exemplar
