#include "gpu/runtime/device/commands.h"

#include <fmt/format.h>

#include <cstdint>

#include "gpu/runtime/device/device.h"
#include "gpu/runtime/device/errors.h"

namespace exemplar {
namespace {

// Makes all writes recorded so far visible to later commands and to the host.
void make_visible(VkCommandBuffer commands) {
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

}  // namespace

Commands::Commands(Device& device) : device_(device), pool_(device.handle()), fence_(device.handle()) {
    auto pool = empty_structure<VkCommandPoolCreateInfo>(VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO);
    pool.flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT;
    pool.queueFamilyIndex = device.queue_family();
    check(vkCreateCommandPool(device.handle(), &pool, nullptr, pool_.put()), "make a command pool");
    const VkCommandBufferAllocateInfo allocate{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                               .pNext = nullptr,
                                               .commandPool = pool_.get(),
                                               .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                               .commandBufferCount = 1};
    check(vkAllocateCommandBuffers(device.handle(), &allocate, &buffer_), "make a command buffer");
    const auto fence = empty_structure<VkFenceCreateInfo>(VK_STRUCTURE_TYPE_FENCE_CREATE_INFO);
    check(vkCreateFence(device.handle(), &fence, nullptr, fence_.put()), "make a fence");
}

Commands::~Commands() {
    const VkFence fence = fence_.get();
    if (state_ == State::submitted) vkWaitForFences(device_.handle(), 1, &fence, VK_TRUE, UINT64_MAX);
}

void Commands::begin() {
    if (state_ == State::submitted)
        throw DeviceError("commands were recorded before the submitted ones were waited for; call wait() first");
    if (state_ == State::recording) return;
    auto info = empty_structure<VkCommandBufferBeginInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO);
    info.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    check(vkBeginCommandBuffer(buffer_, &info), "record commands");
    state_ = State::recording;
}

void Commands::submit(const SubmitOrder& order) {
    begin();
    make_visible(buffer_);
    try {
        check(vkEndCommandBuffer(buffer_), "record commands");
        device_.submit(buffer_, fence_.get(), order);
    } catch (const DeviceError&) {
        reset();
        throw;
    }
    state_ = State::submitted;
}

void Commands::wait() {
    if (state_ != State::submitted) return;
    const VkFence fence = fence_.get();
    const auto what = [&] { return fmt::format("finish the work on device '{}'", device_.info().name); };
    check(vkWaitForFences(device_.handle(), 1, &fence, VK_TRUE, UINT64_MAX), what);
    check(vkResetFences(device_.handle(), 1, &fence), what);
    reset();
}

void Commands::reset() {
    vkResetCommandPool(device_.handle(), pool_.get(), 0);
    state_ = State::idle;
}

}  // namespace exemplar
