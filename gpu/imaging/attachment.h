#pragma once

#include <vulkan/vulkan_core.h>

#include "gpu/runtime/vulkan/memory_allocator.h"
#include "gpu/runtime/vulkan/unique_handle.h"

namespace exemplar {

class Device;

/// An image that can be drawn into, with its memory and its view.
class Attachment {
  public:
    Attachment() = default;
    /// Throws DeviceLimitError if the extent is larger than the device's images can be, DeviceError if memory is
    /// exhausted.
    Attachment(Device& device, VkFormat format, VkExtent2D extent, VkImageUsageFlags usage, VkImageAspectFlags aspect);

    VkImage image() const { return image_.get(); }
    VkImageView view() const { return view_.get(); }

  private:
    // The view is destroyed before the image, the image before its memory.
    MemoryPart memory_;  // returned after the image in it
    UniqueImage image_;
    UniqueImageView view_;
};

/// Returns 32-bit float depth if it can be drawn into, else 24 bits: Vulkan guarantees one of them.
VkFormat depth_format(const Device& device);

}  // namespace exemplar
