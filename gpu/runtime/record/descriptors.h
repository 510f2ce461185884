#pragma once

#include <vulkan/vulkan_core.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "gpu/runtime/kernels/program.h"
#include "gpu/runtime/record/buffer.h"
#include "gpu/runtime/vulkan/unique_handle.h"

namespace exemplar {

class Device;

/// Descriptor sets of one command sequence. A set is kept and bound again by later commands with the same bindings, so
/// that a frame that is recorded like the one before writes none.
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
    /// Call it when the commands are done. Frees all sets once there are many.
    void reset();

  private:
    // The program, and buffer, offset and bytes of each binding, by numbers that are never used twice.
    using Key = std::vector<std::uint64_t>;
    struct Set {
        VkDescriptorSet handle;
        std::vector<UniqueBufferView> views;  // of its texels
    };
    void add_pool();
    VkDescriptorSet allocate(VkDescriptorSetLayout layout);
    Set write(const Program& program, std::span<const BufferRange> ranges);
    UniqueBufferView texel_view(const ReflectedBinding& binding, const VkDescriptorBufferInfo& range);
    Device& device_;
    std::vector<UniqueDescriptorPool> pools_;
    std::size_t current_pool_ = 0;
    std::map<Key, Set> sets_;
    Key key_;  // of the set that is looked for; a member so that its memory is kept
};

}  // namespace exemplar
