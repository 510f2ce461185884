#include "gpu/runtime/record/buffer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "gpu/runtime/device/device.h"
#include "gpu/runtime/device/errors.h"
#include "gpu/runtime/record/stream.h"

namespace exemplar {
namespace {

struct MemoryRequest {
    VkMemoryPropertyFlags required;
    VkMemoryPropertyFlags preferred;
};

constexpr VkMemoryPropertyFlags k_mappable = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;

MemoryRequest memory_request_for(BufferMemory memory) {
    switch (memory) {
        case BufferMemory::upload:
            return {k_mappable, 0};
        case BufferMemory::readback:
            return {k_mappable, VK_MEMORY_PROPERTY_HOST_CACHED_BIT};
        case BufferMemory::device:
            break;
    }
    return {VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, k_mappable | VK_MEMORY_PROPERTY_HOST_CACHED_BIT};
}

// Device memory that is not cached is never mapped: reading it directly is slower than copying.
bool can_map(VkMemoryPropertyFlags properties, BufferMemory memory) {
    const VkMemoryPropertyFlags needed =
        memory == BufferMemory::device ? k_mappable | VK_MEMORY_PROPERTY_HOST_CACHED_BIT : k_mappable;
    return (properties & needed) == needed;
}

// Staged transfers go in pieces, so that they need little memory beside the buffer.
constexpr std::size_t k_piece_bytes = std::size_t{64} << 20;

}  // namespace

Buffer::Resource::Resource(Device& owner, std::size_t capacity, BufferMemory memory)
    : device(owner), allocation(owner.handle()), buffer(owner.handle()) {
    const auto what = [&] {
        return fmt::format("allocate a buffer of {} on '{}'", format_bytes(capacity), device.info().name);
    };
    auto info = empty_structure<VkBufferCreateInfo>(VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO);
    info.size = capacity;
    info.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT |
                 VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT | VK_BUFFER_USAGE_INDEX_BUFFER_BIT |
                 VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    check(vkCreateBuffer(device.handle(), &info, nullptr, buffer.put()), what);
    VkMemoryRequirements needs{};
    vkGetBufferMemoryRequirements(device.handle(), buffer.get(), &needs);
    const MemoryRequest wish = memory_request_for(memory);
    const VkMemoryAllocateInfo allocate{
        .sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
        .pNext = nullptr,
        .allocationSize = needs.size,
        .memoryTypeIndex = device.memory_type(needs.memoryTypeBits, wish.required, wish.preferred)};
    check(vkAllocateMemory(device.handle(), &allocate, nullptr, allocation.put()), what);
    check(vkBindBufferMemory(device.handle(), buffer.get(), allocation.get(), 0), what);
    if (!can_map(device.memory_properties(allocate.memoryTypeIndex), memory)) return;
    void* address = nullptr;
    check(vkMapMemory(device.handle(), allocation.get(), 0, VK_WHOLE_SIZE, 0, &address), what);
    mapped = static_cast<std::byte*>(address);
}

Buffer::Buffer(Device& device, std::size_t bytes, BufferMemory memory) : bytes_(bytes) {
    if (const std::uint64_t limit = device.info().max_allocation; bytes > limit)
        throw DeviceLimitError(fmt::format("a buffer of {} is over the limit of {} of device '{}'; split the work",
                                           format_bytes(bytes), format_bytes(limit), device.info().name),
                               bytes, limit);
    // Rounded up to 16 bytes: Vulkan has no empty buffers, and kernels may bind the tail of a vec4.
    const std::size_t capacity = std::max<std::size_t>((bytes + 15) / 16 * 16, 16);
    resource_ = std::make_shared<Resource>(device, capacity, memory);
}

void Buffer::check_range(std::size_t offset, std::size_t size) const {
    if (offset > bytes_ || size > bytes_ - offset)
        throw DeviceError(
            fmt::format("bytes {} to {} are outside a buffer of {} bytes", offset, offset + size, bytes_));
}

void Buffer::write(std::span<const std::byte> data, std::size_t offset) {
    check_range(offset, data.size());
    if (data.empty()) return;
    if (resource_->mapped) {
        if (resource_->streams != 0) resource_->device.wait_idle();
        std::memcpy(resource_->mapped + offset, data.data(), data.size());
        return;
    }
    Stream stream(resource_->device);
    for (std::size_t begin = 0; begin < data.size(); begin += k_piece_bytes) {
        stream.upload(*this, data.subspan(begin, std::min(k_piece_bytes, data.size() - begin)), offset + begin);
        stream.finish();
    }
}

void Buffer::read(std::span<std::byte> data, std::size_t offset) const {
    check_range(offset, data.size());
    if (data.empty()) return;
    if (resource_->mapped) {
        if (resource_->streams != 0) resource_->device.wait_idle();
        std::memcpy(data.data(), resource_->mapped + offset, data.size());
        return;
    }
    Stream stream(resource_->device);
    for (std::size_t begin = 0; begin < data.size(); begin += k_piece_bytes) {
        stream.download(*this, data.subspan(begin, std::min(k_piece_bytes, data.size() - begin)), offset + begin);
        stream.finish();
    }
}

void reserve(Device& device, Buffer& buffer, std::size_t bytes) {
    if (!buffer || buffer.bytes() < bytes) buffer = Buffer(device, bytes);
}

}  // namespace exemplar
