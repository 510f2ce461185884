#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "gpu/labeling/context_kernels.h"
#include "gpu/runtime/device/device.h"
#include "gpu/runtime/record/buffer.h"
#include "gpu/runtime/record/profiler.h"
#include "gpu/runtime/record/stream.h"
#include "host/labeling/features/context.h"

namespace exemplar {

/// Maximum bytes of a tile's largest buffer, unless the device's limits are lower.
constexpr std::size_t k_context_tile_bytes = std::size_t{256} << 20;

/// Contextual label histograms on the device. Meshes are cut into parts that fit the device's limits; as many parts
/// as fit together are one submission. Values agree with CpuContextHistograms within 1e-5 of a total mass of 1 with
/// a thousand samples: both put every sample into the same bin, but the device sums in single precision.
class GpuContextHistograms final : public ContextHistograms {
  public:
    /// `tile_bytes` limits the size of each kind of buffer, summed over the parts of a submission, below the
    /// device's own limits.
    explicit GpuContextHistograms(Device& device, Profiler* profiler = nullptr,
                                  std::size_t tile_bytes = k_context_tile_bytes);
    void accumulate_all(std::span<const ContextMesh> meshes, std::size_t classes) override;

  private:
    struct Part {
        const ContextMesh* mesh;
        std::size_t all_classes;
        ContextRange samples, faces, classes;
    };
    void add_parts(const ContextMesh& mesh, std::size_t classes, std::vector<Part>& parts) const;
    std::size_t together(std::span<const Part> parts) const;
    void run(std::span<const Part> parts);
    void fetch(std::span<const Part> parts, std::span<const ContextWork> works);
    Device& device_;
    std::size_t tile_bytes_;
    Stream stream_;
    std::optional<ContextKernels> kernels_;  // made at first use
    Buffer probabilities_;                   // samples x classes
    std::vector<float> later_;               // histograms of all but the first range of samples, on the host
};

}  // namespace exemplar
