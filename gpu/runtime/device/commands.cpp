#include "gpu/runtime/device/commands.h"

#include <cstdint>
#include <utility>

#include "gpu/runtime/device/device.h"
#include "gpu/runtime/vulkan/errors.h"
#include "gpu/runtime/vulkan/functions.h"

namespace exemplar {
void record_full_barrier(VkCommandBuffer commands) {
    const VkMemoryBarrier2 all{
        .sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
        .pNext = nullptr,
        .srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
        .srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT,
        .dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT | VK_PIPELINE_STAGE_2_HOST_BIT,
        .dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT | VK_ACCESS_2_HOST_READ_BIT};
    auto dependency = empty_structure<VkDependencyInfo>(VK_STRUCTURE_TYPE_DEPENDENCY_INFO);
    dependency.memoryBarrierCount = 1;
    dependency.pMemoryBarriers = &all;
    vkCmdPipelineBarrier2(commands, &dependency);
}

Commands::Commands(Device& device) : device_(device), memory_(device.lend_commands()) {}

Commands::~Commands() {
    try {
        wait();
    } catch (const DeviceError&) {
        // A lost device runs nothing to wait for.
    }
    device_.return_commands(std::move(memory_));
}

void Commands::begin() {
    if (state_ == State::submitted)
        throw DeviceError("commands were recorded before the submitted ones were waited for; call wait() first");
    if (state_ == State::recording) return;
    auto info = empty_structure<VkCommandBufferBeginInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO);
    info.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    check(vkBeginCommandBuffer(memory_.buffer, &info), "record commands");
    state_ = State::recording;
}

Ticket Commands::submit(const SubmitOrder& order) {
    begin();
    record_full_barrier(memory_.buffer);
    try {
        check(vkEndCommandBuffer(memory_.buffer), "record commands");
        ticket_ = device_.submit(memory_.buffer, order);
    } catch (const DeviceError&) {
        reset();
        throw;
    }
    state_ = State::submitted;
    return ticket_;
}

void Commands::discard() {
    if (state_ == State::recording) reset();
}

void Commands::wait() {
    if (state_ != State::submitted) return;
    device_.wait(ticket_);
    reset();
}

void Commands::reset() {
    vkResetCommandPool(device_.handle(), memory_.pool.get(), 0);
    state_ = State::idle;
}

}  // namespace exemplar
