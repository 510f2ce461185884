#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "gpu/runtime/record/buffer.h"
#include "gpu/runtime/device/device.h"
#include "gpu/runtime/kernels/kernel.h"
#include "gpu/runtime/record/stream.h"
#include "host/animation/animation.h"

namespace exemplar {

/// Poses a surface on the device: morph targets, then linear blend skinning, as pose_vertices() does. Per frame only
/// the pose goes up, 48 bytes per bone and 4 per target. Vertices agree with the reference to single precision: sums
/// are taken in another order.
class GpuPoser {
  public:
    /// `rest` has the vertices that the rig moves. A rig without bones (of a mesh sequence) takes set_vertices() alone.
    /// Throws UsageError if the rig contradicts itself or `rest`, DeviceLimitError if kernels cannot see all of it.
    GpuPoser(Device& device, const Rig& rig, std::span<const Vec3> rest);

    /// Poses the vertices. Throws UsageError if the pose is not of the rig, or the rig has no bones.
    void record(Stream& stream, const Pose& pose);
    /// Takes the vertices from the host instead, a frame of a mesh sequence. Throws UsageError if there are not as many
    /// as at rest.
    void set_vertices(Stream& stream, std::span<const Vec3> vertices);
    /// A vec4 (x, y, z, 1) per vertex; at rest until a pose has been recorded and run.
    const Buffer& vertices() const { return vertices_; }
    std::size_t vertex_count() const { return vertex_count_; }

  private:
    void upload_rig(Device& device, const Rig& rig, std::span<const Vec3> rest);
    void upload_targets(Device& device, const Rig& rig);
    Rig skeleton_;  // without what is on the device
    std::size_t vertex_count_, target_count_;
    Kernel kernel_;
    Buffer rest_, influences_, morph_begin_, morphs_, pose_, vertices_;
};

}  // namespace exemplar
