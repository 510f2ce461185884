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

/// A mesh's ContextGeometry on the device, in tiles of faces that fit the device's limits. Made once per mesh, then
/// used by every round of the cascade.
class DeviceContextGeometry {
  public:
    /// `tile_bytes` bounds the memory of each of a tile's buffers below the device's own limits.
    /// Throws UsageError if the geometry's sizes contradict each other, DeviceError if it does not fit into device
    /// memory.
    DeviceContextGeometry(Device& device, const ContextGeometry& geometry,
                          std::size_t tile_bytes = std::size_t{256} << 20);

    std::size_t faces() const { return faces_; }
    std::size_t samples() const { return sample_face_.size(); }
    std::size_t tiles() const { return tiles_.size(); }

  private:
    friend class GpuContextHistograms;
    struct Tile {
        std::size_t first;  ///< face
        std::size_t faces;
        Buffer ranges;     ///< sample quads x faces, a byte per sample
        Buffer positions;  ///< axes x faces
    };
    void sort_samples(Device& device, const ContextGeometry& geometry);
    void add_tile(Device& device, const ContextGeometry& geometry, std::size_t first, std::size_t faces);
    std::size_t faces_;
    std::vector<std::uint32_t> sample_face_;
    std::vector<float> sample_area_;
    std::array<std::array<float, k_context_bins - 1>, k_context_axes> axis_edges_;
    std::array<std::vector<std::uint32_t>, k_context_axes> order_;  // samples by rising position along each axis
    Buffer sorted_;                                                 // their positions, axes x samples
    std::vector<Tile> tiles_;
};

/// Contextual label histograms on the device. Values agree with CpuContextHistograms within 1e-5 of a total mass of 1:
/// both put every sample into the same bin, but the device sums in single precision.
class GpuContextHistograms final : public ContextHistograms {
  public:
    explicit GpuContextHistograms(Device& device, Profiler* profiler = nullptr);
    /// Uploads the geometry first; with several calls per mesh keep a DeviceContextGeometry instead.
    void accumulate(const ContextGeometry& geometry, std::span<const float> probabilities, std::size_t classes,
                    std::span<float> out) override;
    /// Sizes as in ContextHistograms; throws UsageError if they do not fit the geometry.
    void accumulate(const DeviceContextGeometry& geometry, std::span<const float> probabilities, std::size_t classes,
                    std::span<float> out);

  private:
    void accumulate_tile(const DeviceContextGeometry& geometry, const DeviceContextGeometry::Tile& tile,
                         std::size_t classes, const Buffer& masses, const Buffer& prefixes, std::span<float> out);
    Device& device_;
    std::uint32_t faces_per_thread_;
    Stream stream_;
    Kernel geodesic_kernel_, axes_kernel_;
    Buffer histograms_;        // kept between calls
    std::vector<float> tile_;  // a tile's histograms on the host
};

}  // namespace exemplar
