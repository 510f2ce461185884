#include "gpu/runtime/device/staging_pool.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <numeric>

#include "gpu/runtime/device/device.h"
#include "gpu/runtime/vulkan/errors.h"
#include "gpu/runtime/vulkan/functions.h"

namespace exemplar {
namespace {

constexpr std::size_t k_smallest_staging = std::size_t{1} << 20;
constexpr std::size_t k_most_idle = std::size_t{256} << 20;  // bytes of blocks that nobody uses

}  // namespace

std::unique_ptr<StagingBlock> StagingPool::lend(std::size_t bytes, StagingUse use) {
    const std::size_t wanted = std::bit_ceil(std::max(bytes, k_smallest_staging));
    {
        const std::lock_guard lock(mutex_);
        const auto fits = [&](const auto& block) { return block->use == use && block->bytes == wanted; };
        if (const auto found = std::ranges::find_if(idle_, fits); found != idle_.end()) {
            std::unique_ptr<StagingBlock> block = std::move(*found);
            idle_.erase(found);
            return block;
        }
    }
    return make(wanted, use);
}

std::unique_ptr<StagingBlock> StagingPool::make(std::size_t bytes, StagingUse use) {
    const bool reads = use == StagingUse::readback;
    const auto what = [&] {
        return fmt::format("allocate {} of staging memory for '{}'", format_bytes(bytes), device_.info().name);
    };
    auto block = std::make_unique<StagingBlock>(
        StagingBlock{.use = use, .bytes = bytes, .memory = {}, .buffer = UniqueBuffer(device_.handle())});
    auto info = empty_structure<VkBufferCreateInfo>(VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO);
    info.size = bytes;
    info.usage = reads ? VK_BUFFER_USAGE_TRANSFER_DST_BIT : VK_BUFFER_USAGE_TRANSFER_SRC_BIT;
    check(vkCreateBuffer(device_.handle(), &info, nullptr, block->buffer.put()), what);
    VkMemoryRequirements needs{};
    vkGetBufferMemoryRequirements(device_.handle(), block->buffer.get(), &needs);
    const std::uint32_t type = device_.memory_type(
        needs.memoryTypeBits, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT,
        reads ? VK_MEMORY_PROPERTY_HOST_CACHED_BIT : 0);
    check(device_.memory().allocate(needs, type, MemoryContent::buffer, block->memory), what);
    check(vkBindBufferMemory(device_.handle(), block->buffer.get(), block->memory.memory(), block->memory.offset()),
          what);
    device_.host_work().add(HostTask::buffer);
    return block;
}

// Those that have been idle for longest go first.
void StagingPool::give_back(std::unique_ptr<StagingBlock> block) {
    block->used = 0;
    const std::lock_guard lock(mutex_);
    idle_.push_back(std::move(block));
    std::size_t sum = std::accumulate(idle_.begin(), idle_.end(), std::size_t{0},
                                      [](std::size_t bytes, const auto& other) { return bytes + other->bytes; });
    while (sum > k_most_idle) {
        sum -= idle_.front()->bytes;
        idle_.erase(idle_.begin());
    }
}

}  // namespace exemplar
