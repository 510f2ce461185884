#pragma once

#include <vulkan/vulkan_core.h>

#include <cstddef>
#include <memory>
#include <mutex>
#include <vector>

#include "gpu/runtime/vulkan/memory_allocator.h"
#include "gpu/runtime/vulkan/unique_handle.h"

namespace exemplar {

class Device;

/// Which way data passes through staging memory.
enum class StagingUse : std::uint8_t {
    upload,    ///< the host writes, the device reads once
    readback,  ///< the device writes, the host reads: cached memory
};

/// A mapped buffer in host memory, with the part of it that is in use.
struct StagingBlock {
    StagingUse use;
    std::size_t bytes;
    MemoryPart memory;  // returned after the buffer in it
    UniqueBuffer buffer;
    std::size_t used = 0;
    std::byte* mapped() const { return memory.mapped(); }
    std::size_t left() const { return bytes - used; }
};

/// Lends mapped host memory to streams. Blocks have sizes of powers of two, at least 1 MiB, and are kept for the next
/// stream: making them takes a card's driver milliseconds. Any thread may use it.
class StagingPool {
  public:
    explicit StagingPool(Device& device) : device_(device) {}

    /// Returns a block of at least `bytes` bytes. Throws DeviceMemoryError if memory is used up.
    std::unique_ptr<StagingBlock> lend(std::size_t bytes, StagingUse use);
    /// Takes back a block that the device has finished with.
    void give_back(std::unique_ptr<StagingBlock> block);

  private:
    std::unique_ptr<StagingBlock> make(std::size_t bytes, StagingUse use);
    Device& device_;
    std::mutex mutex_;
    std::vector<std::unique_ptr<StagingBlock>> idle_;  // by the time of their return
};

}  // namespace exemplar
