#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "gpu/runtime/device/device.h"
#include "gpu/runtime/kernels/kernel.h"
#include "gpu/runtime/record/buffer.h"
#include "gpu/runtime/record/stream.h"
#include "host/animation/animation.h"

namespace exemplar {

/// Poses a surface on the device: morph targets, then linear blend skinning, as pose_vertices() does. Per frame only
/// the pose is uploaded, 48 bytes per bone and 4 per target. The order of summation differs, so vertices agree with
/// the reference to single precision.
class GpuPoser {
  public:
    /// `rest`: the vertices that the rig moves. With a rig without bones (a mesh sequence), only set_vertices() may
    /// be used. Throws UsageError if the rig is inconsistent or does not match `rest`, DeviceLimitError if it
    /// exceeds the device's texel limit.
    GpuPoser(Device& device, const Rig& rig, std::span<const Vec3> rest);

    /// Records posing the vertices. Throws UsageError if the pose is not of the rig, or the rig has no bones.
    void record(Stream& stream, const Pose& pose);
    /// Uploads vertices, a frame of a mesh sequence, instead. Throws UsageError for another number than at rest.
    void set_vertices(Stream& stream, std::span<const Vec3> vertices);
    /// A vec4 (x, y, z, 1) per vertex; the rest positions until a recorded pose has run.
    const Buffer& vertices() const { return vertices_; }
    std::size_t vertex_count() const { return vertex_count_; }

  private:
    void upload_rig(Device& device, const Rig& rig, std::span<const Vec3> rest);
    void upload_targets(Device& device, const Rig& rig);
    Rig skeleton_;  // nodes and bones only; the rest is on the device
    std::size_t vertex_count_, target_count_;
    Kernel kernel_;
    Buffer rest_, influences_, morph_begin_, morphs_, pose_, vertices_;
};

}  // namespace exemplar
