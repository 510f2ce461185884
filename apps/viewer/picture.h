#pragma once

#include <volk.h>

#include <array>

#include "gpu/imaging/attachment.h"
#include "gpu/runtime/device.h"
#include "gpu/runtime/pass.h"
#include "gpu/runtime/stream.h"

namespace exemplar {

/// An image of 8-bit sRGB with depth that scenes are drawn into, off the screen.
class Picture {
  public:
    static constexpr VkFormat k_color = VK_FORMAT_R8G8B8A8_UNORM;

    explicit Picture(Device& device);
    /// Its contents are lost unless the size stays. No work that uses it may be under way.
    void resize(VkExtent2D extent);
    VkExtent2D extent() const { return extent_; }
    VkImage image() const { return color_.image(); }
    VkFormat depth() const { return depth_format_; }

    /// Makes it ready to be drawn into, then to be copied.
    void begin(Stream& stream) const;
    void end(Stream& stream) const;
    /// Between begin and end.
    PassTarget target() const;

  private:
    Device& device_;
    VkFormat depth_format_;
    VkExtent2D extent_{};
    Attachment color_, depth_;
};

}  // namespace exemplar
