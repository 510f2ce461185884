#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "gpu/runtime/buffer.h"
#include "gpu/runtime/device.h"
#include "gpu/runtime/kernel.h"
#include "gpu/runtime/profiler.h"
#include "gpu/runtime/stream.h"
#include "host/labeling/context.h"

namespace exemplar {

/// What a tile's largest buffer takes at most, unless the device's limits are lower.
constexpr std::size_t k_context_tile_bytes = std::size_t{256} << 20;

/// Contextual label histograms on the device. Values agree with CpuContextHistograms within 1e-5 of a total mass of 1:
/// both put every sample into the same bin, but the device sums in single precision.
class GpuContextHistograms final : public ContextHistograms {
  public:
    /// Some of the faces, samples or classes.
    struct Range {
        std::size_t first;
        std::size_t count;
    };
    /// `tile_bytes` bounds the memory of each buffer below the device's own limits.
    explicit GpuContextHistograms(Device& device, Profiler* profiler = nullptr,
                                  std::size_t tile_bytes = k_context_tile_bytes);
    /// Uploads the geometry tile by tile: it need not fit into device memory, nor its samples into one buffer.
    void accumulate(const ContextGeometry& geometry, std::span<const float> probabilities, std::size_t classes,
                    std::span<float> out) override;

  private:
    struct Job {
        const ContextGeometry& geometry;
        std::span<const float> probabilities;
        std::size_t classes;
        std::span<float> out;
    };
    // As many samples as fit at once.
    struct Samples {
        Samples(Device& device, const ContextGeometry& geometry, Range range);
        Range range;
        std::span<const std::uint32_t> face;
        std::span<const float> area;
        std::array<std::vector<std::uint32_t>, k_context_axes> order;  // by rising position along each axis
        Buffer sorted;                                                 // their positions, axes x samples
    };
    // As many faces as fit at once.
    struct Tile {
        // Uploads by the stream, before what it records next.
        Tile(Device& device, Stream& stream, const ContextGeometry& geometry, Range samples, Range faces);
        Range faces;
        Buffer ranges;     // blocks of 16 samples x faces x 16 samples, a byte each
        Buffer positions;  // axes x faces
    };
    // Some classes' masses.
    struct ClassChunk {
        Range classes;
        Buffer masses;    // class blocks x samples
        Buffer prefixes;  // axes x class blocks x (samples + 1)
    };
    std::vector<ClassChunk> class_chunks(const Job& job, const Samples& samples, std::size_t tile_faces);
    void add_tile(const Job& job, const Samples& samples, const Tile& tile, const ClassChunk& chunk);
    Device& device_;
    std::size_t tile_bytes_;
    std::uint32_t faces_per_thread_;
    Stream stream_;
    Kernel geodesic_kernel_, axes_kernel_;
    Buffer histograms_;        // kept between calls
    std::vector<float> tile_;  // a tile's histograms on the host
};

}  // namespace exemplar
