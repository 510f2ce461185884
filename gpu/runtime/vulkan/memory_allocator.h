#pragma once

#include <vulkan/vulkan_core.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "gpu/runtime/vulkan/host_work.h"

namespace exemplar {

/// What is placed in memory. Buffers and images never share a block: some devices need a distance between them
/// (bufferImageGranularity).
enum class MemoryContent : std::uint8_t { buffer, image };

class MemoryAllocator;

/// A part of the device's memory, returned by the destructor. Movable; a default-constructed one is empty.
class MemoryPart {
  public:
    MemoryPart() = default;
    MemoryPart(MemoryPart&& other) noexcept { swap(other); }
    MemoryPart& operator=(MemoryPart&& other) noexcept {
        swap(other);
        return *this;
    }
    MemoryPart(const MemoryPart&) = delete;
    MemoryPart& operator=(const MemoryPart&) = delete;
    ~MemoryPart();

    VkDeviceMemory memory() const { return memory_; }
    VkDeviceSize offset() const { return offset_; }
    /// Returns the host's address of the first byte, or null if the memory's type is not host-visible and coherent.
    std::byte* mapped() const { return mapped_; }

  private:
    friend class MemoryAllocator;
    void swap(MemoryPart& other) noexcept {
        std::swap(allocator_, other.allocator_);
        std::swap(memory_, other.memory_);
        std::swap(offset_, other.offset_);
        std::swap(mapped_, other.mapped_);
    }
    MemoryAllocator* allocator_ = nullptr;
    VkDeviceMemory memory_ = VK_NULL_HANDLE;
    VkDeviceSize offset_ = 0;
    std::byte* mapped_ = nullptr;
};

/// Places buffers and images in large blocks of device memory, as devices allow few allocations (4,096 by the
/// specification) and each takes long. Blocks grow from 4 to 64 MiB; what is larger than 16 MiB has a block of its
/// own. Any thread may use it. Parts must be gone before it is destroyed.
class MemoryAllocator {
  public:
    MemoryAllocator(VkDevice device, const VkPhysicalDeviceMemoryProperties& types, HostWorkCounter& work);
    ~MemoryAllocator();
    MemoryAllocator(const MemoryAllocator&) = delete;
    MemoryAllocator& operator=(const MemoryAllocator&) = delete;

    /// Sets `part`, which must be empty, to memory of the given type. Returns the error of vkAllocateMemory or
    /// vkMapMemory.
    VkResult allocate(const VkMemoryRequirements& needs, std::uint32_t type, MemoryContent content, MemoryPart& part);
    /// Returns the number of allocations that the device holds now.
    std::size_t live_allocations() const;

  private:
    struct Block;
    friend class MemoryPart;
    void release(const MemoryPart& part);
    VkResult add_block(std::uint32_t type, MemoryContent content, VkDeviceSize bytes, Block*& added);
    VkDeviceSize next_block_bytes(std::uint32_t type, MemoryContent content) const;
    VkDevice device_;
    VkPhysicalDeviceMemoryProperties types_;
    HostWorkCounter& work_;
    mutable std::mutex mutex_;
    std::vector<std::unique_ptr<Block>> blocks_;
};

}  // namespace exemplar
