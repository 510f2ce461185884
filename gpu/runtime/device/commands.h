#pragma once

#include <volk.h>

#include "gpu/runtime/device/unique_handle.h"

namespace exemplar {

class Device;

/// What work waits for and tells on the device, beside the fence: null is nothing.
struct SubmitOrder {
    VkSemaphore wait = VK_NULL_HANDLE;
    VkPipelineStageFlags2 wait_stage = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;  ///< which of its stages waits
    VkSemaphore signal = VK_NULL_HANDLE;
};

/// One command buffer, recorded, submitted and waited for, then recorded again. What its commands wrote is visible to
/// all later submissions and to the host: sequences need no barriers between them. One thread at a time may use it.
class Commands {
  public:
    enum class State { idle, recording, submitted };

    explicit Commands(Device& device);
    /// Waits for submitted work.
    ~Commands();
    Commands(const Commands&) = delete;
    Commands& operator=(const Commands&) = delete;

    State state() const { return state_; }
    /// Only while recording.
    VkCommandBuffer handle() const { return buffer_; }

    /// Starts recording unless it has started. Throws DeviceError while submitted work has not been waited for.
    void begin();
    /// Makes everything recorded visible and hands it to the device; returns at once. Nothing is left recorded if it
    /// throws.
    void submit(const SubmitOrder& order = {});
    /// Waits until submitted work is done, if there is any. Throws DeviceLostError if the device was lost.
    void wait();

  private:
    void reset();
    Device& device_;
    UniqueCommandPool pool_;
    UniqueFence fence_;
    VkCommandBuffer buffer_ = VK_NULL_HANDLE;
    State state_ = State::idle;
};

}  // namespace exemplar
