#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "gpu/runtime/device/device.h"
#include "gpu/runtime/kernels/kernel.h"
#include "gpu/runtime/record/buffer.h"
#include "gpu/runtime/record/profiler.h"
#include "gpu/runtime/record/stream.h"
#include "host/labeling/features/context.h"

namespace exemplar {

/// Maximum bytes of a tile's largest buffer, unless the device's limits are lower.
constexpr std::size_t k_context_tile_bytes = std::size_t{256} << 20;

/// Faces per invocation. On a CPU each loaded sample is used for many faces: D6 in docs/portability.md.
inline constexpr std::array<std::uint32_t, 4> k_faces_per_invocation{1, 2, 4, 8};
inline constexpr TunableParameter k_context_faces{"labeling/context_geodesic.comp", "faces", k_faces_per_invocation, 4,
                                                  1};

/// Contextual label histograms on the device. Meshes are cut into parts that fit the device's limits; as many parts
/// as fit together are one submission. Values agree with CpuContextHistograms within 1e-5 of a total mass of 1 with
/// a thousand samples: both put every sample into the same bin, but the device sums in single precision.
class GpuContextHistograms final : public ContextHistograms {
  public:
    /// A range of faces, samples or classes.
    struct Range {
        std::size_t first;
        std::size_t count;
    };
    /// `tile_bytes` limits the size of each kind of buffer, summed over the parts of a submission, below the
    /// device's own limits.
    explicit GpuContextHistograms(Device& device, Profiler* profiler = nullptr,
                                  std::size_t tile_bytes = k_context_tile_bytes);
    void accumulate_all(std::span<const ContextMesh> meshes, std::size_t classes) override;

  private:
    // The work of one pair of dispatches.
    struct Part {
        const ContextMesh* mesh;
        std::size_t all_classes;
        Range samples, faces, classes;
    };
    // The device buffers of a part, reused between calls.
    struct Slot {
        Buffer ranges;     // blocks of 16 samples x faces x 16 samples, a byte each
        Buffer masses;     // class blocks x samples
        Buffer positions;  // axes x faces
        Buffer sorted;     // axes x samples: their positions, rising
        Buffer prefixes;   // axes x class blocks x (samples + 1)
        Buffer geodesic;   // bins x classes x faces: histograms
        Buffer axes;       // axes x bins x classes x faces
    };
    void add_parts(const ContextMesh& mesh, std::size_t classes, std::vector<Part>& parts) const;
    std::size_t together(std::span<const Part> parts) const;
    void run(std::span<const Part> parts);
    std::size_t kept_bytes() const;
    void reserve_slot(const Part& part, Slot& slot);
    void upload(const Part& part, Slot& slot);
    void dispatch(const Part& part, const Slot& slot);
    void fetch(std::span<const Part> parts);
    template <typename Use>
    static void for_each_column(const Part& part, Use&& use);
    Device& device_;
    std::size_t tile_bytes_;
    std::uint32_t faces_per_thread_;
    Stream stream_;
    Kernel geodesic_kernel_, axes_kernel_;
    std::vector<Slot> slots_;
    std::vector<float> later_;  // histograms of all but the first range of samples, on the host
};

}  // namespace exemplar
