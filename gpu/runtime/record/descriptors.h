#pragma once

#include <volk.h>

#include <cstddef>
#include <span>
#include <vector>

#include "gpu/runtime/device/unique_handle.h"
#include "gpu/runtime/kernels/program.h"
#include "gpu/runtime/record/buffer.h"

namespace exemplar {

class Device;

/// Descriptor sets of one command sequence.
class Descriptors {
  public:
    explicit Descriptors(Device& device) : device_(device) {}
    Descriptors(const Descriptors&) = delete;
    Descriptors& operator=(const Descriptors&) = delete;

    /// Throws ShaderError if the ranges do not match the program's bindings, DeviceLimitError if one exceeds the
    /// device's limits or has an offset that the device cannot bind.
    void check_bindings(const Program& program, std::span<const BufferRange> ranges) const;
    /// Records the binding of ranges that passed check_bindings.
    void bind(VkCommandBuffer commands, const Program& program, std::span<const BufferRange> ranges);
    /// Frees all sets; call it when the commands are done.
    void reset();

  private:
    void add_pool();
    VkDescriptorSet allocate(VkDescriptorSetLayout layout);
    VkBufferView texel_view(const ReflectedBinding& binding, const VkDescriptorBufferInfo& range);
    Device& device_;
    std::vector<UniqueDescriptorPool> pools_;
    std::size_t current_pool_ = 0;
    std::vector<UniqueBufferView> views_;
};

}  // namespace exemplar
