#include "gpu/runtime/vulkan/memory_allocator.h"

#include <algorithm>
#include <optional>

#include "gpu/runtime/vulkan/errors.h"
#include "gpu/runtime/vulkan/functions.h"
#include "gpu/runtime/vulkan/unique_handle.h"

namespace exemplar {
namespace {

constexpr VkDeviceSize k_smallest_block = VkDeviceSize{4} << 20, k_largest_block = VkDeviceSize{64} << 20;
constexpr VkDeviceSize k_largest_shared = VkDeviceSize{16} << 20;  // what is larger has a block of its own

VkDeviceSize round_up(VkDeviceSize value, VkDeviceSize alignment) {
    return (value + alignment - 1) / alignment * alignment;
}

}  // namespace

MemoryPart::~MemoryPart() {
    if (allocator_) allocator_->release(*this);
}

/// One allocation of device memory, divided into parts in use and free ranges.
struct MemoryAllocator::Block {
    std::uint32_t type;
    MemoryContent content;
    VkDeviceSize bytes;
    UniqueMemory memory;
    std::byte* mapped;
    std::map<VkDeviceSize, VkDeviceSize> free, used;  // bytes by offset

    bool is_empty() const { return used.empty(); }
    bool holds(std::uint32_t of_type, MemoryContent of_content) const {
        return type == of_type && content == of_content;
    }

    // Takes the first free range that holds the bytes, and returns their offset.
    std::optional<VkDeviceSize> take(VkDeviceSize size, VkDeviceSize alignment) {
        for (auto range = free.begin(); range != free.end(); ++range) {
            const VkDeviceSize begin = round_up(range->first, alignment), end = range->first + range->second;
            if (begin + size > end) continue;
            const VkDeviceSize first = range->first;
            free.erase(range);
            if (begin > first) free[first] = begin - first;
            if (end > begin + size) free[begin + size] = end - begin - size;
            used[begin] = size;
            return begin;
        }
        return std::nullopt;
    }

    // Returns bytes in use to the free ranges, and joins neighboring ones.
    void give_back(VkDeviceSize offset) {
        const auto part = used.find(offset);
        auto range = free.emplace(offset, part->second).first;
        used.erase(part);
        if (const auto next = std::next(range); next != free.end() && range->first + range->second == next->first) {
            range->second += next->second;
            free.erase(next);
        }
        if (range == free.begin()) return;
        if (const auto before = std::prev(range); before->first + before->second == range->first) {
            before->second += range->second;
            free.erase(range);
        }
    }
};

MemoryAllocator::MemoryAllocator(VkDevice device, const VkPhysicalDeviceMemoryProperties& types, HostWorkCounter& work)
    : device_(device), types_(types), work_(work) {}

MemoryAllocator::~MemoryAllocator() = default;

std::size_t MemoryAllocator::live_allocations() const {
    const std::lock_guard lock(mutex_);
    return blocks_.size();
}

// Blocks double, so that small programs take little and large ones have few; none is over a sixteenth of its heap.
VkDeviceSize MemoryAllocator::next_block_bytes(std::uint32_t type, MemoryContent content) const {
    VkDeviceSize sum = 0;
    for (const auto& block : blocks_)
        if (block->type == type && block->content == content) sum += block->bytes;
    const VkDeviceSize heap = types_.memoryHeaps[types_.memoryTypes[type].heapIndex].size;
    return std::clamp(sum, k_smallest_block, std::max(std::min(k_largest_block, heap / 16), k_smallest_block));
}

VkResult MemoryAllocator::add_block(std::uint32_t type, MemoryContent content, VkDeviceSize bytes, Block*& added) {
    auto block = std::make_unique<Block>(Block{.type = type,
                                               .content = content,
                                               .bytes = bytes,
                                               .memory = UniqueMemory(device_),
                                               .mapped = nullptr,
                                               .free = {{0, bytes}},
                                               .used = {}});
    const VkMemoryAllocateInfo info{.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                    .pNext = nullptr,
                                    .allocationSize = bytes,
                                    .memoryTypeIndex = type};
    VkResult result = vkAllocateMemory(device_, &info, nullptr, block->memory.put());
    if (result != VK_SUCCESS) return result;
    work_.add(HostTask::allocation);
    constexpr VkMemoryPropertyFlags k_visible =
        VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    if ((types_.memoryTypes[type].propertyFlags & k_visible) == k_visible) {
        void* address = nullptr;
        result = vkMapMemory(device_, block->memory.get(), 0, VK_WHOLE_SIZE, 0, &address);
        if (result != VK_SUCCESS) return result;
        block->mapped = static_cast<std::byte*>(address);
    }
    added = blocks_.emplace_back(std::move(block)).get();
    return VK_SUCCESS;
}

VkResult MemoryAllocator::allocate(const VkMemoryRequirements& needs, std::uint32_t type, MemoryContent content,
                                   MemoryPart& part) {
    const std::lock_guard lock(mutex_);
    Block* in = nullptr;
    std::optional<VkDeviceSize> offset;
    for (const auto& block : blocks_) {
        if (!block->holds(type, content)) continue;
        offset = block->take(needs.size, needs.alignment);
        if (!offset) continue;
        in = block.get();
        break;
    }
    if (!in) {
        const bool shares = needs.size <= k_largest_shared;
        VkResult result =
            add_block(type, content, shares ? std::max(next_block_bytes(type, content), needs.size) : needs.size, in);
        if (result == VK_ERROR_OUT_OF_DEVICE_MEMORY || result == VK_ERROR_OUT_OF_HOST_MEMORY) {
            std::erase_if(blocks_, [](const auto& block) { return block->is_empty(); });
            result = add_block(type, content, needs.size, in);
        }
        if (result != VK_SUCCESS) return result;
        offset = in->take(needs.size, needs.alignment);
    }
    part.allocator_ = this;
    part.memory_ = in->memory.get();
    part.offset_ = *offset;
    part.mapped_ = in->mapped ? in->mapped + *offset : nullptr;
    return VK_SUCCESS;
}

// Keeps one empty block of each kind for the next that needs memory; other empty blocks return to the device.
void MemoryAllocator::release(const MemoryPart& part) {
    const std::lock_guard lock(mutex_);
    const auto of_part = [&](const auto& block) { return block->memory.get() == part.memory(); };
    Block& block = **std::ranges::find_if(blocks_, of_part);
    block.give_back(part.offset());
    if (!block.is_empty()) return;
    const bool keeps = block.bytes <= k_largest_block;
    std::erase_if(blocks_, [&](const auto& other) {
        if (!keeps) return other.get() == &block;
        return other.get() != &block && other->is_empty() && other->holds(block.type, block.content);
    });
}

}  // namespace exemplar
