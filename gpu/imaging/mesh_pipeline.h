#pragma once

#include <volk.h>

#include <array>

#include "gpu/runtime/buffer.h"
#include "gpu/runtime/unique_handle.h"

namespace exemplar {

class Device;

/// Storage buffers that the vertex shader reads: corners, positions, normals, colors (see shaders/imaging/mesh.vert).
constexpr std::size_t k_mesh_buffers = 4;

/// The graphics pipeline of shaders/imaging/mesh.vert and .frag, with its one descriptor set: depth test, no culling,
/// viewport and scissor set while drawing, shared::RenderParameters as push constants of both stages.
class MeshPipeline {
  public:
    /// Throws DeviceError if the device's queue cannot draw.
    MeshPipeline(Device& device, VkFormat color, VkFormat depth);

    /// Makes the descriptor set refer to these buffers, in the order of their binding numbers; no work that uses the
    /// set may be under way. Throws DeviceLimitError if one is over the device's max_storage_range.
    void bind(const std::array<const Buffer*, k_mesh_buffers>& buffers);

    VkPipeline handle() const { return pipeline_.get(); }
    VkPipelineLayout layout() const { return layout_.get(); }
    VkDescriptorSet set() const { return set_; }

  private:
    void create_layout();
    void create_set();
    void create_pipeline(VkFormat color, VkFormat depth);
    Device& device_;
    UniqueSetLayout set_layout_;
    UniquePipelineLayout layout_;
    UniquePipeline pipeline_;
    UniqueDescriptorPool pool_;
    VkDescriptorSet set_ = VK_NULL_HANDLE;
};

}  // namespace exemplar
