#include "gpu/imaging/canvas.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "host/core/errors.h"

namespace exemplar {
namespace {

constexpr VkPipelineStageFlags2 k_depth_tests =
    VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT;
constexpr VkAccessFlags2 k_depth_use =
    VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT | VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;
constexpr VkAccessFlags2 k_color_use = VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT;
// Waits for the copies of the previous picture.
constexpr Transition k_color_begins{VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_NONE,
                                    VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT, k_color_use};
constexpr Transition k_color_goes_on{VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                                     VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT,
                                     VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT, k_color_use};
constexpr Transition k_color_ends{VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                                  VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
                                  VK_ACCESS_2_TRANSFER_READ_BIT};
constexpr Transition k_depth_begins{VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT | k_depth_tests,
                                    VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT, k_depth_tests, k_depth_use};
constexpr Transition k_depth_ends{k_depth_tests, VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT,
                                  VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_READ_BIT};

constexpr std::size_t k_depth_bytes = 4;

std::size_t texel_bytes(VkFormat color) {
    return color == VK_FORMAT_R16G16B16A16_SFLOAT ? 8 : 4;
}

std::size_t pixel_count(VkExtent2D extent) {
    return std::size_t{extent.width} * extent.height;
}

}  // namespace

Canvas::Canvas(Device& device, VkFormat color)
    : device_(device), color_format_(color), depth_format_(exemplar::depth_format(device)) {}

void Canvas::resize(VkExtent2D extent) {
    if (extent.width == 0 || extent.height == 0)
        throw UsageError(fmt::format("an empty picture ({} x {})", extent.width, extent.height));
    if (extent.width == extent_.width && extent.height == extent_.height) return;
    extent_ = {};  // until everything has been allocated
    color_ =
        Attachment(device_, color_format_, extent,
                   VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT, VK_IMAGE_ASPECT_COLOR_BIT);
    depth_ = Attachment(device_, depth_format_, extent,
                        VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
                        VK_IMAGE_ASPECT_DEPTH_BIT);
    extent_ = extent;
}

void Canvas::begin(Stream& stream) const {
    stream.transition(color_.image(), VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_UNDEFINED,
                      VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, k_color_begins);
    stream.transition(depth_.image(), VK_IMAGE_ASPECT_DEPTH_BIT, VK_IMAGE_LAYOUT_UNDEFINED,
                      VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL, k_depth_begins);
}

void Canvas::separate_passes(Stream& stream) const {
    stream.transition(color_.image(), VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                      VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, k_color_goes_on);
}

void Canvas::end(Stream& stream) const {
    stream.transition(color_.image(), VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                      VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, k_color_ends);
}

PassTarget Canvas::target() const {
    return {.color = color_.view(), .depth = depth_.view(), .extent = extent_};
}

PassTarget Canvas::cleared(const std::array<float, 4>& color) const {
    PassTarget result = target();
    result.clear_color = color;
    result.clear_depth = 1.0f;
    return result;
}

void Canvas::copy_depth(Stream& stream, const Buffer& target) const {
    stream.transition(depth_.image(), VK_IMAGE_ASPECT_DEPTH_BIT, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL,
                      VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, k_depth_ends);
    stream.copy_image(depth_.image(), VK_IMAGE_ASPECT_DEPTH_BIT, extent_, k_depth_bytes, target);
}

void Canvas::copy_color(Stream& stream, VkExtent2D part, const Buffer& target) const {
    stream.copy_image(color_.image(), VK_IMAGE_ASPECT_COLOR_BIT, part, texel_bytes(color_format_), target);
}

void Canvas::record_download(Stream& stream) {
    rgba_.resize(4 * pixel_count(extent_));
    stream.download_image(color_.image(), VK_IMAGE_ASPECT_COLOR_BIT, extent_, std::as_writable_bytes(std::span(rgba_)));
}

Image Canvas::read_image(bool with_alpha) const {
    const std::size_t channels = with_alpha ? 4 : 3;
    Image image(static_cast<int>(extent_.width), static_cast<int>(extent_.height), static_cast<int>(channels));
    for (std::size_t i = 0; i < pixel_count(extent_); ++i) {
        const std::uint8_t alpha = rgba_[4 * i + 3];
        for (std::size_t c = 0; c < 3; ++c) {
            const unsigned value = rgba_[4 * i + c];
            const unsigned straight = alpha ? std::min(255u, (255 * value + alpha / 2) / alpha) : 0;
            image.data[channels * i + c] = static_cast<std::uint8_t>(with_alpha ? straight : value);
        }
        if (with_alpha) image.data[channels * i + 3] = alpha;
    }
    return image;
}

}  // namespace exemplar
