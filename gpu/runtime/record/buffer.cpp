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

constexpr std::size_t k_vector_bytes = 16;

std::uint64_t next_buffer_id() {
    static std::atomic<std::uint64_t> last = 0;
    return ++last;
}

}  // namespace

std::size_t padded_buffer_bytes(std::size_t bytes) {
    return std::max((bytes + k_vector_bytes - 1) / k_vector_bytes * k_vector_bytes, k_vector_bytes);
}

Buffer::Resource::Resource(Device& owner, VkBuffer borrowed) : device(owner), id(next_buffer_id()), handle(borrowed) {}

Buffer::Resource::Resource(Device& owner, std::size_t capacity)
    : device(owner), id(next_buffer_id()), owned(owner.handle()) {
    const auto what = [&] {
        return fmt::format("allocate a buffer of {} on '{}'", format_bytes(capacity), device.info().name);
    };
    auto info = empty_structure<VkBufferCreateInfo>(VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO);
    info.size = capacity;
    info.usage = k_usage;
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
    const std::size_t capacity = padded_buffer_bytes(bytes);
    resource_ = std::make_shared<Resource>(device, capacity);
    if (device.switches().poisons) poison(capacity);
}

Buffer Buffer::borrow(Device& device, VkBuffer handle, std::size_t bytes) {
    if (bytes == 0 || bytes % k_vector_bytes != 0)
        throw DeviceError(
            fmt::format("a borrowed buffer of {} bytes; make it a multiple of {}", bytes, k_vector_bytes));
    Buffer buffer;
    buffer.bytes_ = bytes;
    buffer.resource_ = std::make_shared<Resource>(device, handle);
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
