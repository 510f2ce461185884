#pragma once

#include <array>
#include <functional>
#include <vector>

#include "gpu/imaging/attachment.h"
#include "gpu/runtime/stream.h"
#include "tests/gpu/support/environment.h"

namespace exemplar::testing {

/// An image with depth that a test draws into and reads back.
class Canvas {
  public:
    static constexpr VkFormat k_format = VK_FORMAT_R8G8B8A8_UNORM;

    Canvas(std::uint32_t width, std::uint32_t height)
        : extent_{width, height},
          color_(
              shared_device(), k_format, extent_,
              VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT,
              VK_IMAGE_ASPECT_COLOR_BIT),
          depth_(shared_device(), depth_format(shared_device()), extent_, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT,
                 VK_IMAGE_ASPECT_DEPTH_BIT) {}

    VkExtent2D extent() const { return extent_; }
    VkImage image() const { return color_.image(); }
    PassTarget target(std::array<float, 4> clear) const {
        return {.color = color_.view(),
                .depth = depth_.view(),
                .extent = extent_,
                .clear_color = clear,
                .clear_depth = 1.0f};
    }
    VkImageView view() const { return color_.view(); }

    /// Clears it, lets `record` draw, and returns its texels, red lowest.
    std::vector<std::uint32_t> draw(std::array<float, 4> clear, const std::function<void(Stream&)>& record) {
        Stream stream(shared_device());
        begin(stream);
        stream.render(Pass("clear", target(clear)));
        record(stream);
        end(stream);
        return read(stream);
    }
    void begin(Stream& stream) const {
        stream.transition(color_.image(), VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_UNDEFINED,
                          VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, k_all);
        stream.transition(depth_.image(), VK_IMAGE_ASPECT_DEPTH_BIT, VK_IMAGE_LAYOUT_UNDEFINED,
                          VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL, k_all);
    }
    void end(Stream& stream) const {
        stream.transition(color_.image(), VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                          VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, k_all);
    }
    /// In VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL.
    std::vector<std::uint32_t> read(Stream& stream) const {
        std::vector<std::uint32_t> texels(std::size_t{extent_.width} * extent_.height);
        const Buffer buffer(shared_device(), 4 * texels.size());
        stream.copy_image(color_.image(), VK_IMAGE_ASPECT_COLOR_BIT, extent_, 4, buffer);
        stream.fetch<std::uint32_t>(buffer, texels);
        return texels;
    }

    static constexpr Transition k_all{VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_WRITE_BIT,
                                      VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                                      VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT};

  private:
    VkExtent2D extent_;
    Attachment color_, depth_;
};

}  // namespace exemplar::testing
