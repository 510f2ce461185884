#pragma once

#include <volk.h>

#include <array>

#include "gpu/imaging/attachment.h"
#include "gpu/runtime/record/buffer.h"
#include "gpu/runtime/device/device.h"
#include "gpu/runtime/record/pass.h"
#include "gpu/runtime/record/stream.h"
#include "host/imaging/image.h"

namespace exemplar {

/// Color with depth that passes draw into off the screen, and where it goes from there: to buffers, to other images, or
/// to the host. Of each picture begin() comes first and end() last.
class Canvas {
  public:
    static constexpr VkFormat k_rgba = VK_FORMAT_R8G8B8A8_UNORM;  ///< sRGB-encoded

    /// `color` has 4 bytes a pixel (8 bits a channel, or one number), or is VK_FORMAT_R16G16B16A16_SFLOAT. There are no
    /// pixels yet.
    explicit Canvas(Device& device, VkFormat color = k_rgba);

    /// Its contents are lost unless the size stays. No work that uses it may be under way. Throws UsageError if it is
    /// empty, DeviceLimitError if it is larger than the device's images can be.
    void resize(VkExtent2D extent);
    VkExtent2D extent() const { return extent_; }
    VkFormat color_format() const { return color_format_; }
    VkFormat depth_format() const { return depth_format_; }
    VkImage image() const { return color_.image(); }
    VkImageView color_view() const { return color_.view(); }

    /// Makes it ready to be drawn into; what was there may be gone.
    void begin(Stream& stream) const;
    /// Between two passes: the later one sees the colors of the earlier one.
    void go_on(Stream& stream) const;
    /// Leaves the colors in VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, visible to copies.
    void end(Stream& stream) const;
    /// Of all of it, drawn over what is there.
    PassTarget target() const;
    /// Of all of it, cleared: to this color, as the image has it, and to the largest depth.
    PassTarget cleared(const std::array<float, 4>& color) const;

    /// Copies depths, 4 bytes each, row by row; after that nothing is drawn with them until begin().
    void copy_depth(Stream& stream, const Buffer& target) const;
    /// Copies a part at the upper left, row by row. After end().
    void copy_color(Stream& stream, VkExtent2D part, const Buffer& target) const;
    /// Records the download of all colors of a canvas of 8 bits a channel. After end(); when the work is done,
    /// read_image() has it.
    void record_download(Stream& stream);
    /// RGB, or RGBA of colors that were drawn multiplied by their alpha.
    Image read_image(bool with_alpha = false) const;

  private:
    Device& device_;
    VkFormat color_format_, depth_format_;
    VkExtent2D extent_{};
    Attachment color_, depth_;
    Buffer pixels_;
};

}  // namespace exemplar
