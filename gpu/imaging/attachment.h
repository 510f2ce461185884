#pragma once

#include <volk.h>

#include "gpu/runtime/device/unique_handle.h"

namespace exemplar {

class Device;

/// An image that is drawn into, with its memory and its view.
class Attachment {
  public:
    Attachment() = default;
    /// Throws DeviceLimitError if it is larger than the device's images can be, DeviceError if memory is used up.
    Attachment(Device& device, VkFormat format, VkExtent2D extent, VkImageUsageFlags usage, VkImageAspectFlags aspect);

    VkImage image() const { return image_.get(); }
    VkImageView view() const { return view_.get(); }

  private:
    // The view ends before the image, the image before its memory.
    UniqueMemory memory_;
    UniqueImage image_;
    UniqueImageView view_;
};

/// 32-bit float depth where it can be drawn into, else 24 bits: Vulkan promises one of them.
VkFormat depth_format(const Device& device);

}  // namespace exemplar
