#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "gpu/runtime/device/device.h"
#include "gpu/runtime/kernels/kernel.h"
#include "gpu/runtime/record/buffer.h"
#include "gpu/runtime/record/profiler.h"
#include "gpu/runtime/record/stream.h"
#include "host/hatching/placement/placement_grid.h"
#include "host/hatching/placement/streamlines.h"
#include "shaders/shared/hatching.h"

namespace exemplar {

/// Places strokes on the device in the same rounds as the reference, with identical results. Rounds are recorded in
/// batches, between which the host reads a few counters; strokes are downloaded at the end.
class GpuStrokePlacer final : public StrokePlacer {
  public:
    explicit GpuStrokePlacer(Device& device, Profiler* profiler = nullptr);
    using StrokePlacer::place;
    /// Also throws DeviceLimitError for pictures over the device's limits; a picture takes two texels per pixel.
    std::vector<HatchStroke> place(const HatchingFields& fields, std::span<const std::uint8_t> barriers,
                                   const StrokeOptions& options, std::span<const HatchStroke> kept) override;

  private:
    void upload(const PlacementGrid& grid, std::span<const FineStroke> kept, std::span<const std::uint32_t> near);
    void upload_lists(const PlacementGrid& grid, std::span<const FineStroke> kept);
    void upload_kept(std::span<const FineStroke> kept);
    void record_round(std::uint32_t rounds_left);
    void record_end();
    void place_all();
    void grow_buffers();
    std::vector<FineStroke> download();

    Device& device_;
    Stream stream_;
    Kernel seed_, trace_, claim_, check_claims_, end_round_, place_;
    shared::PlacementParameters parameters_{};
    shared::PlacementCounts counts_{};
    Buffer grid_, near_, claims_, lists_, trials_, ways_, points_, strokes_, count_buffer_;  // reused by later calls
};

}  // namespace exemplar
