#pragma once

#include <vulkan/vulkan_core.h>

namespace exemplar {

/// How an image is used before and after a barrier.
struct Transition {
    VkPipelineStageFlags2 source_stage;
    VkAccessFlags2 source_access;
    VkPipelineStageFlags2 target_stage;
    VkAccessFlags2 target_access;
};

/// Records a change of an image's layout; its contents survive unless `from` is VK_IMAGE_LAYOUT_UNDEFINED.
void change_layout(VkCommandBuffer commands, VkImage image, VkImageAspectFlags aspect, VkImageLayout from,
                   VkImageLayout to, const Transition& transition);

}  // namespace exemplar
