#pragma once

#include <vulkan/vulkan_core.h>

#include <cstddef>
#include <cstdint>

#include "gpu/runtime/record/buffer.h"
#include "gpu/runtime/vulkan/unique_handle.h"

namespace exemplar {

/// A buffer whose memory other Vulkan devices, CUDA or OpenGL on the same card use too, by a file descriptor (handle
/// type VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT). Whoever uses it must order its work with the others', for
/// example by a SharedSemaphore. Must outlive all work that uses it.
class SharedBuffer {
  public:
    /// Makes a buffer and memory to be shared. Throws DeviceError if the device cannot (VK_KHR_external_memory_fd; on
    /// an adopted device the program must have enabled it).
    SharedBuffer(Device& device, std::size_t bytes);
    /// Uses memory that another device has made: `memory_bytes` is its memory_bytes() there, `descriptor` belongs to
    /// the driver afterwards. Throws as above; then the descriptor is still the caller's.
    SharedBuffer(Device& device, std::size_t bytes, std::size_t memory_bytes, int descriptor);

    /// The buffer, of the wanted bytes rounded up to a multiple of 16.
    const Buffer& buffer() const { return buffer_; }
    /// Returns the size of the memory behind the buffer.
    std::size_t memory_bytes() const { return memory_bytes_; }
    /// Returns a new descriptor of the memory. The caller closes it, or hands it to one importer.
    int descriptor() const;

  private:
    void create(std::size_t bytes);
    void bind(std::size_t memory_bytes, const void* next);
    Device& device_;
    std::size_t memory_bytes_ = 0;
    UniqueMemory memory_;  // freed after the buffer in it
    UniqueBuffer handle_;
    Buffer buffer_;
};

/// A semaphore that other devices and APIs can wait for and signal too, by a file descriptor
/// (VK_EXTERNAL_SEMAPHORE_HANDLE_TYPE_OPAQUE_FD_BIT). For SubmitOrder.
class SharedSemaphore {
  public:
    /// Throws DeviceError if the device cannot (VK_KHR_external_semaphore_fd).
    explicit SharedSemaphore(Device& device);
    VkSemaphore handle() const { return handle_.get(); }
    /// Returns a new descriptor, as SharedBuffer::descriptor.
    int descriptor() const;

  private:
    Device& device_;
    UniqueSemaphore handle_;
};

}  // namespace exemplar
