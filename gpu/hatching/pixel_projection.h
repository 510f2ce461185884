#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "gpu/hatching/buffer_cache.h"
#include "gpu/runtime/device/device.h"
#include "gpu/runtime/kernels/kernel.h"
#include "gpu/runtime/record/buffer.h"
#include "gpu/runtime/record/profiler.h"
#include "gpu/runtime/record/stream.h"
#include "host/hatching/features/pixel_projection.h"
#include "shaders/shared/hatching_features.h"

namespace exemplar {

/// Interpolates data of vertices at points of faces on the device. Data of a mesh stay there from view to view.
/// Agrees with CpuPixelProjection up to the rounding of floats: scalars within 1e-6 of the largest value at the
/// corners, directions within 1e-5 unless those at the corners cancel out. Repeated runs on one device give the same
/// bytes. Only one thread at a time may use it.
class GpuPixelProjection final : public PixelProjection {
  public:
    /// `tile_points` is the maximum number of points projected at once, `kept_bytes` the size of the cache for data
    /// of meshes. The device's limits apply, too.
    explicit GpuPixelProjection(Device& device, Profiler* profiler = nullptr,
                                std::size_t tile_points = std::size_t{1} << 20,
                                std::size_t kept_bytes = std::size_t{256} << 20);

    /// All three also throw DeviceLimitError if the mesh has more faces than the number of texels that a kernel can
    /// access, or more vertices than an eighth of that number.
    void scalars(const TriangleMesh& mesh, const FacePoints& points, const FeatureMatrix& values,
                 std::span<const std::uint32_t> which, std::span<float> out) override;
    void curvature(const HatchingSurface& surface, const HatchingView& view, const FacePoints& points,
                   std::span<const std::uint32_t> which, std::span<float> out) override;
    void directions(const TriangleMesh& mesh, const HatchingView& view, const FacePoints& points,
                    std::span<const std::span<const Vec3>> fields, std::span<DoubledAngle> out) override;

  private:
    using Shared = std::shared_ptr<Buffer>;
    struct Tile {
        std::size_t first, count, stride;
    };
    template <typename Use>
    void for_each_tile(const FacePoints& points, Use&& use);
    void upload_points(const FacePoints& points, const Tile& tile);
    void download(const Buffer& source, std::span<const HostReadback> parts);
    void finish();
    void project(const TriangleMesh& mesh, const FacePoints& points, std::span<const Shared> slabs,
                 std::span<float> out);
    Shared corners(const TriangleMesh& mesh);
    Shared positions(const TriangleMesh& mesh);
    Shared scalar_slab(const FeatureMatrix& values, std::span<const std::uint32_t> which);
    Shared directions_slab(std::span<const std::span<const Vec3>> fields);
    Shared curvature_states(const HatchingSurface& surface);
    Shared curvature_slab(const Buffer& states, const HatchingSurface& surface, const HatchingView& view,
                          std::span<const std::uint32_t> which);
    void record_curvature(const Buffer& states, const Buffer& slab, std::size_t vertices,
                          const shared::ViewCurvatureParameters& parameters);

    Device& device_;
    std::size_t tile_points_;
    Stream stream_;
    Kernel project_, directions_, view_curvature_;
    BufferCache kept_;
    Buffer faces_, barycentrics_, columns_, doubled_;  // of a tile
    std::size_t waiting_bytes_ = 0;                    // of recorded downloads
};

/// Returns the fastest projection for a device: CpuPixelProjection if the device is the host's processor.
std::unique_ptr<PixelProjection> projection_for(Device& device);

}  // namespace exemplar
