#include "apps/viewer/picture.h"

namespace exemplar {
namespace {

constexpr VkPipelineStageFlags2 k_depth_tests =
    VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT;
constexpr Transition k_color_begins{VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_NONE,
                                    VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                                    VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT};
constexpr Transition k_depth_begins{
    k_depth_tests, VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT, k_depth_tests,
    VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT | VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT};
constexpr Transition k_color_drawn{VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                                   VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
                                   VK_ACCESS_2_TRANSFER_READ_BIT};

}  // namespace

Picture::Picture(Device& device) : device_(device), depth_format_(depth_format(device)) {}

void Picture::resize(VkExtent2D extent) {
    if (extent.width == extent_.width && extent.height == extent_.height) return;
    extent_ = {};  // until all of it is there
    color_ = Attachment(device_, k_color, extent, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
                        VK_IMAGE_ASPECT_COLOR_BIT);
    depth_ = Attachment(device_, depth_format_, extent, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT,
                        VK_IMAGE_ASPECT_DEPTH_BIT);
    extent_ = extent;
}

void Picture::begin(Stream& stream) const {
    stream.transition(color_.image(), VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_UNDEFINED,
                      VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, k_color_begins);
    stream.transition(depth_.image(), VK_IMAGE_ASPECT_DEPTH_BIT, VK_IMAGE_LAYOUT_UNDEFINED,
                      VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL, k_depth_begins);
}

void Picture::end(Stream& stream) const {
    stream.transition(color_.image(), VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                      VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, k_color_drawn);
}

PassTarget Picture::target() const {
    return {.color = color_.view(), .depth = depth_.view(), .extent = extent_};
}

}  // namespace exemplar
