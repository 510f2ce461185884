#include "gpu/runtime/record/buffer.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cstring>
#include <utility>

#include "gpu/runtime/device/device.h"
#include "gpu/runtime/record/stream.h"
#include "gpu/runtime/vulkan/errors.h"
#include "gpu/runtime/vulkan/functions.h"

namespace exemplar {
namespace {

// Device memory that the host sees is used directly only if it is cached: reading it is slower than copying otherwise.
constexpr VkMemoryPropertyFlags k_mapped_properties =
    VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT | VK_MEMORY_PROPERTY_HOST_CACHED_BIT;

// Staged transfers go in pieces, so that they need little memory beside the buffer.
constexpr std::size_t k_piece_bytes = std::size_t{64} << 20;

std::uint64_t next_buffer_id() {
    static std::atomic<std::uint64_t> last = 0;
    return ++last;
}

}  // namespace

Buffer::Resource::Resource(Device& owner, VkBuffer borrowed, std::size_t size)
    : device(owner), id(next_buffer_id()), capacity(size), handle(borrowed) {}

Buffer::Resource::Resource(Device& owner, std::size_t size)
    : device(owner), id(next_buffer_id()), capacity(size), owned(owner.handle()) {
    const auto what = [&] {
        return fmt::format("allocate a buffer of {} on '{}'", format_bytes(capacity), device.info().name);
    };
    auto info = empty_structure<VkBufferCreateInfo>(VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO);
    info.size = capacity;
    info.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT |
                 VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT | VK_BUFFER_USAGE_INDEX_BUFFER_BIT |
                 VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    check(vkCreateBuffer(device.handle(), &info, nullptr, owned.put()), what);
    handle = owned.get();
    VkMemoryRequirements needs{};
    vkGetBufferMemoryRequirements(device.handle(), handle, &needs);
    const bool maps = device.switches().maps_memory;
    const std::uint32_t type =
        device.memory_type(needs.memoryTypeBits, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, maps ? k_mapped_properties : 0);
    check(device.memory().allocate(needs, type, MemoryContent::buffer, memory), what);
    check(vkBindBufferMemory(device.handle(), handle, memory.memory(), memory.offset()), what);
    device.host_work().add(HostTask::buffer);
    if (maps && (device.memory_properties(type) & k_mapped_properties) == k_mapped_properties) mapped = memory.mapped();
}

Buffer::Buffer(Device& device, std::size_t bytes) : bytes_(bytes) {
    if (const std::uint64_t limit = device.info().max_allocation; bytes > limit)
        throw DeviceLimitError(fmt::format("a buffer of {} is over the limit of {} of device '{}'; split the work",
                                           format_bytes(bytes), format_bytes(limit), device.info().name),
                               bytes, limit);
    // Rounded up to 16 bytes: Vulkan has no empty buffers, and kernels may bind the tail of a vec4.
    const std::size_t capacity = std::max<std::size_t>((bytes + 15) / 16 * 16, 16);
    resource_ = std::make_shared<Resource>(device, capacity);
    if (device.switches().poisons) poison(capacity);
}

Buffer Buffer::borrow(Device& device, VkBuffer handle, std::size_t bytes) {
    Buffer buffer;
    buffer.bytes_ = bytes;
    buffer.resource_ = std::make_shared<Resource>(device, handle, bytes);
    return buffer;
}

void Buffer::poison(std::size_t capacity) {
    constexpr unsigned char k_poison = 0xff;
    if (std::byte* memory = resource_->memory.mapped()) {
        std::memset(memory, k_poison, capacity);
        return;
    }
    Stream stream(resource_->device);
    stream.fill(*this, 0xffffffffu);
    stream.finish();
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
        if (resource_->streams != 0) resource_->device.wait(resource_->last_use);
        std::memcpy(resource_->mapped + offset, data.data(), data.size());
        resource_->device.host_work().add(HostTask::byte_up, data.size());
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
        if (resource_->streams != 0) resource_->device.wait(resource_->last_use);
        std::memcpy(data.data(), resource_->mapped + offset, data.size());
        resource_->device.host_work().add(HostTask::byte_down, data.size());
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
