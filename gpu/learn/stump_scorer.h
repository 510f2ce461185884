#pragma once

#include <cstddef>
#include <map>
#include <span>

#include "gpu/runtime/buffer.h"
#include "gpu/runtime/device.h"
#include "gpu/runtime/kernel.h"
#include "gpu/runtime/profiler.h"
#include "gpu/runtime/stream.h"
#include "host/learn/boosted_stumps.h"

namespace exemplar {

/// Boosted stumps on the device. Only the features that stumps use are uploaded, in tiles of rows that fit the device's
/// limits. Probabilities agree with CpuStumpScorer within 1e-5: sums are taken in another order, and exp differs
/// between devices.
class GpuStumpScorer final : public StumpScorer {
  public:
    /// `tile_bytes` bounds the memory of a tile's features and of its probabilities below the device's own limits.
    explicit GpuStumpScorer(Device& device, Profiler* profiler = nullptr,
                            std::size_t tile_bytes = std::size_t{256} << 20);
    void probabilities(const BoostedStumps& classifier, const FeatureMatrix& features, Link link, float scale,
                       std::span<float> out) override;

  private:
    const Kernel& kernel(std::uint32_t classes);
    std::size_t tile_unit() const;
    std::size_t rows_per_tile(std::size_t rows, std::size_t columns, std::size_t classes) const;
    Device& device_;
    std::uint32_t quads_;  // of items per invocation
    std::size_t tile_bytes_;
    Stream stream_;
    std::map<std::uint32_t, Kernel> kernels_;  // by class count
    Buffer features_, probabilities_;          // kept between calls
};

}  // namespace exemplar
