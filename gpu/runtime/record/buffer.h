#pragma once

#include <vulkan/vulkan_core.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <type_traits>

#include "gpu/runtime/device/commands.h"
#include "gpu/runtime/vulkan/memory_allocator.h"
#include "gpu/runtime/vulkan/unique_handle.h"

namespace exemplar {

class Device;

/// A storage, texel and index buffer in the device's memory, which the host sees where both share cached memory.
/// Streams that use a buffer keep its memory alive until they are done. Contents are undefined until written. Movable,
/// not copyable; a default-constructed buffer has no memory.
class Buffer {
  public:
    Buffer() = default;
    /// Throws DeviceLimitError if the device cannot allocate that much at once, DeviceMemoryError if memory is used up.
    Buffer(Device& device, std::size_t bytes);
    Buffer(Buffer&&) = default;
    Buffer& operator=(Buffer&&) = default;
    Buffer(const Buffer&) = delete;
    Buffer& operator=(const Buffer&) = delete;

    /// A device buffer holding `values`.
    template <typename T>
    static Buffer of(Device& device, std::span<const T> values) {
        Buffer buffer(device, values.size_bytes());
        buffer.upload(values);
        return buffer;
    }

    /// The Vulkan usages that every buffer is created with.
    static constexpr VkBufferUsageFlags k_usage =
        VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT |
        VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT | VK_BUFFER_USAGE_INDEX_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
        VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    /// A buffer of the caller's with `bytes` bytes, a positive multiple of 16, as kernels may read four values at once;
    /// throws DeviceError for another number. It needs those bits of k_usage that it is used for, and must outlive all
    /// work that uses it. Memory barriers of streams cover it; the caller's own work must be ordered before and after
    /// theirs.
    static Buffer borrow(Device& device, VkBuffer handle, std::size_t bytes);

    std::size_t bytes() const { return bytes_; }
    VkBuffer handle() const { return resource_ ? resource_->handle : VK_NULL_HANDLE; }
    explicit operator bool() const { return resource_ != nullptr; }

    /// Waits for all submitted work that uses the buffer, then writes `values` at byte `offset` and returns. Work
    /// that is recorded but not yet submitted reads the new values too.
    template <typename T>
    void upload(std::span<const T> values, std::size_t offset = 0) {
        static_assert(std::is_trivially_copyable_v<T>);
        write(std::as_bytes(values), offset);
    }
    /// Waits for all submitted work that uses the buffer, then reads `values.size()` values from byte `offset`.
    template <typename T>
    void download(std::span<T> values, std::size_t offset = 0) const {
        static_assert(std::is_trivially_copyable_v<T>);
        read(std::as_writable_bytes(values), offset);
    }
    void write(std::span<const std::byte> data, std::size_t offset);
    void read(std::span<std::byte> data, std::size_t offset) const;

    /// The Vulkan objects behind a buffer.
    struct Resource {
        Resource(Device& owner, std::size_t capacity);
        Resource(Device& owner, VkBuffer borrowed);
        Resource(const Resource&) = delete;
        Resource& operator=(const Resource&) = delete;

        Device& device;
        const std::uint64_t id;  ///< of no other buffer, not even of one that takes the place of this one
        MemoryPart memory;       // returned after the buffer in it
        UniqueBuffer owned;      // none if the buffer is the caller's
        VkBuffer handle = VK_NULL_HANDLE;
        std::byte* mapped = nullptr;             ///< null if the host does not see the memory
        std::atomic<std::uint32_t> streams = 0;  ///< streams that have recorded a use and are not done
        std::atomic<Ticket> last_use = 0;        ///< the last submission that uses it
    };
    const std::shared_ptr<Resource>& resource() const { return resource_; }
    /// Throws DeviceError if bytes [offset, offset + size) are not all in the buffer.
    void check_range(std::size_t offset, std::size_t size) const;

  private:
    void poison(std::size_t capacity);
    std::shared_ptr<Resource> resource_;
    std::size_t bytes_ = 0;
};

/// Returns the bytes that a Vulkan buffer has for so many: a multiple of 16, as kernels may bind the tail of a vec4,
/// and at least 16, as Vulkan has no empty buffers.
std::size_t padded_buffer_bytes(std::size_t bytes);

/// Replaces the buffer by a new one, of undefined contents, if it has fewer than `bytes` bytes.
void reserve(Device& device, Buffer& buffer, std::size_t bytes);

/// A part of a buffer for a binding of a kernel.
struct BufferRange {
    BufferRange(const Buffer& whole)
        : buffer(&whole), offset(0), bytes(whole.bytes()) {}  // NOLINT: a buffer is its whole range
    /// `first` must be a multiple of DeviceInfo::storage_alignment, or of texel_alignment for a binding of texels.
    BufferRange(const Buffer& part_of, std::size_t first, std::size_t size)
        : buffer(&part_of), offset(first), bytes(size) {}
    const Buffer* buffer;
    std::size_t offset;  ///< bytes
    std::size_t bytes;
};

}  // namespace exemplar
