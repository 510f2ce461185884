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

/// The samples of a mesh's ContextGeometry, on the device as far as kernels read them themselves.
class DeviceContextSamples {
  public:
    /// Throws UsageError if the geometry's sizes contradict each other.
    DeviceContextSamples(Device& device, const ContextGeometry& geometry);
    std::size_t count() const { return face_.size(); }

  private:
    friend class GpuContextHistograms;
    std::vector<std::uint32_t> face_;
    std::vector<float> area_;
    std::array<std::array<float, k_context_bins - 1>, k_context_axes> axis_edges_;
    std::array<std::vector<std::uint32_t>, k_context_axes> order_;  // by rising position along each axis
    Buffer sorted_;                                                 // their positions, axes x samples
};

/// Some faces of a ContextGeometry on the device.
struct DeviceContextTile {
    /// Uploads faces [first, first + faces).
    DeviceContextTile(Device& device, const ContextGeometry& geometry, std::size_t first, std::size_t faces);
    std::size_t first;
    std::size_t faces;
    Buffer ranges;     ///< blocks of 16 samples x faces x 16 samples, a byte each
    Buffer positions;  ///< axes x faces
};

/// A mesh's ContextGeometry on the device, in tiles of faces that fit the device's limits. Made once per mesh, then
/// used by every round of the cascade.
class DeviceContextGeometry {
  public:
    /// `tile_bytes` bounds the memory of each of a tile's buffers below the device's own limits.
    /// Throws UsageError if the geometry's sizes contradict each other, DeviceError if it does not fit into device
    /// memory as a whole.
    DeviceContextGeometry(Device& device, const ContextGeometry& geometry,
                          std::size_t tile_bytes = k_context_tile_bytes);

    std::size_t faces() const { return faces_; }
    std::size_t samples() const { return samples_.count(); }
    std::size_t tiles() const { return tiles_.size(); }

  private:
    friend class GpuContextHistograms;
    std::size_t faces_;
    DeviceContextSamples samples_;
    std::vector<DeviceContextTile> tiles_;
};

/// Contextual label histograms on the device. Values agree with CpuContextHistograms within 1e-5 of a total mass of 1:
/// both put every sample into the same bin, but the device sums in single precision.
class GpuContextHistograms final : public ContextHistograms {
  public:
    /// `tile_bytes` bounds the memory of each buffer below the device's own limits.
    explicit GpuContextHistograms(Device& device, Profiler* profiler = nullptr,
                                  std::size_t tile_bytes = k_context_tile_bytes);
    /// Uploads the geometry first, tile by tile: it need not fit into device memory. With several calls per mesh that
    /// does, keep a DeviceContextGeometry instead.
    void accumulate(const ContextGeometry& geometry, std::span<const float> probabilities, std::size_t classes,
                    std::span<float> out) override;
    /// Sizes as in ContextHistograms; throws UsageError if they do not fit the geometry.
    void accumulate(const DeviceContextGeometry& geometry, std::span<const float> probabilities, std::size_t classes,
                    std::span<float> out);

  private:
    // Some classes' masses; all classes of many, or of many samples, may be over the device's limits at once.
    struct ClassChunk {
        std::size_t first;
        std::size_t count;
        Buffer masses;    // class blocks x samples
        Buffer prefixes;  // axes x class blocks x (samples + 1)
    };
    struct Output {
        std::span<float> values;
        std::size_t faces;
        std::size_t classes;
    };
    std::vector<ClassChunk> class_chunks(const DeviceContextSamples& samples, std::span<const float> probabilities,
                                         std::size_t classes, std::size_t tile_faces);
    void accumulate_tile(const DeviceContextSamples& samples, const DeviceContextTile& tile, const ClassChunk& chunk,
                         const Output& out);
    Device& device_;
    std::size_t tile_bytes_;
    std::uint32_t faces_per_thread_;
    Stream stream_;
    Kernel geodesic_kernel_, axes_kernel_;
    Buffer histograms_;        // kept between calls
    std::vector<float> tile_;  // a tile's histograms on the host
};

}  // namespace exemplar
