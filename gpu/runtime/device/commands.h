#pragma once

#include <vulkan/vulkan_core.h>

#include <cstdint>
#include <optional>

#include "gpu/runtime/vulkan/unique_handle.h"

namespace exemplar {

class Device;

/// Semaphores of a submission; null: none.
struct SubmitOrder {
    VkSemaphore wait = VK_NULL_HANDLE;
    VkPipelineStageFlags2 wait_stage = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;  ///< stages of the work that wait
    VkSemaphore signal = VK_NULL_HANDLE;
    std::uint64_t wait_value = 0, signal_value = 0;  ///< of timeline semaphores
};

/// Number of a submission to a device, counted from 1. Submissions end in this order.
using Ticket = std::uint64_t;

/// A command buffer in a pool of its own.
struct CommandMemory {
    UniqueCommandPool pool;
    VkCommandBuffer buffer = VK_NULL_HANDLE;
};

/// Records a barrier that makes all writes recorded so far visible to all later commands and to the host.
void record_full_barrier(VkCommandBuffer commands);

/// A command buffer that is recorded, submitted, waited for and then recorded again. Its writes are visible to all
/// later submissions and to the host, so submissions need no barriers between them. One thread at a time may use it.
class Commands {
  public:
    enum class State { idle, recording, submitted };

    explicit Commands(Device& device);
    /// Waits for submitted work.
    ~Commands();
    Commands(const Commands&) = delete;
    Commands& operator=(const Commands&) = delete;

    State state() const { return state_; }
    /// Valid only while recording.
    VkCommandBuffer handle() const { return memory_.buffer; }

    /// Starts recording unless it has started. Throws DeviceError while submitted work has not been waited for.
    void begin();
    /// Ends recording with a barrier that makes all writes visible, submits, and returns at once. Discards what was
    /// recorded if it throws.
    Ticket submit(const SubmitOrder& order = {});
    /// Drops what was recorded and not submitted.
    void discard();
    /// Waits until submitted work is done, if there is any. Throws DeviceLostError if the device was lost.
    void wait();

  private:
    void reset();
    Device& device_;
    CommandMemory memory_;
    Ticket ticket_ = 0;
    State state_ = State::idle;
};

}  // namespace exemplar
