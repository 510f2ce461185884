#pragma once

#include <vulkan/vulkan_core.h>

#include <array>

#include "gpu/imaging/attachment.h"
#include "gpu/runtime/device/device.h"
#include "gpu/runtime/record/buffer.h"
#include "gpu/runtime/record/pass.h"
#include "gpu/runtime/record/stream.h"
#include "host/imaging/image.h"

namespace exemplar {

/// An off-screen color image with depth. Passes draw into it; its colors can be copied to buffers, other images or
/// the host. For each picture, begin() is called first and end() last.
class Canvas {
  public:
    static constexpr VkFormat k_rgba = VK_FORMAT_R8G8B8A8_UNORM;  ///< sRGB-encoded

    /// `color` has 4 bytes per pixel (8 bits per channel, or one number), or is VK_FORMAT_R16G16B16A16_SFLOAT. The
    /// canvas starts without pixels.
    explicit Canvas(Device& device, VkFormat color = k_rgba);

    /// Changes the size; the contents are lost unless it stays the same. No work that uses the canvas may be in
    /// flight. Throws UsageError if the size is zero, DeviceLimitError if it is larger than the device's images can
    /// be.
    void resize(VkExtent2D extent);
    VkExtent2D extent() const { return extent_; }
    VkFormat depth_format() const { return depth_format_; }
    VkImage image() const { return color_.image(); }
    VkImageView color_view() const { return color_.view(); }

    /// Makes the canvas ready to be drawn into; previous contents may be lost.
    void begin(Stream& stream) const;
    /// Separates two passes, so that the later one sees the colors of the earlier one.
    void separate_passes(Stream& stream) const;
    /// Leaves the colors in VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, visible to copies.
    void end(Stream& stream) const;
    /// Returns a target for the whole canvas that keeps its contents.
    PassTarget target() const;
    /// Returns a target for the whole canvas that clears it, to this color (encoded as in the image) and to the
    /// largest depth.
    PassTarget cleared(const std::array<float, 4>& color) const;

    /// Copies the depths, 4 bytes each, row by row. After that nothing may be drawn with them until begin().
    void copy_depth(Stream& stream, const Buffer& target) const;
    /// Copies the colors of a part at the upper left, row by row. Call after end().
    void copy_color(Stream& stream, VkExtent2D part, const Buffer& target) const;
    /// Records the download of all colors of a canvas with 8 bits per channel. Call after end(). read_image()
    /// returns them once the work is done.
    void record_download(Stream& stream);
    /// Returns an RGB image; with alpha, an RGBA image that is not premultiplied, from colors drawn multiplied by
    /// their alpha.
    Image read_image(bool with_alpha = false) const;

  private:
    Device& device_;
    VkFormat color_format_, depth_format_;
    VkExtent2D extent_{};
    Attachment color_, depth_;
    std::vector<std::uint8_t> rgba_;  // of record_download
};

}  // namespace exemplar
