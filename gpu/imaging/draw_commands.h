#pragma once

#include <volk.h>

#include <functional>

#include "gpu/imaging/unique_handle.h"

namespace exemplar {

class Device;

/// A command buffer for work that gpu/runtime's Stream does not know, such as drawing.
class DrawCommands {
  public:
    explicit DrawCommands(Device& device);
    /// Records, submits and waits; what the commands wrote is then visible to later work and to the host.
    void run(const std::function<void(VkCommandBuffer)>& record);

  private:
    Device& device_;
    UniqueCommandPool pool_;
    UniqueFence fence_;
    VkCommandBuffer commands_ = VK_NULL_HANDLE;
};

/// How one image or all memory is used before and after a barrier.
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
