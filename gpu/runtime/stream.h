#pragma once

#include <volk.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "gpu/runtime/buffer.h"
#include "gpu/runtime/hazards.h"
#include "gpu/runtime/kernel.h"
#include "gpu/runtime/profiler.h"

namespace exemplar {

/// How many invocations a dispatch needs. A plain count may exceed any number of groups: groups are folded into y and
/// z, and the shader finds its item with linear_thread() of shaders/lib/dispatch.glsl. Counts per axis are for 2D and
/// 3D kernels that use gl_GlobalInvocationID. Kernels check their item's index: the last groups overshoot.
struct Threads {
    Threads(std::uint64_t count) : x(count), foldable(true) {}  // NOLINT: a plain count reads best
    Threads(std::uint64_t width, std::uint64_t height, std::uint64_t depth = 1) : x(width), y(height), z(depth) {}
    std::uint64_t x;
    std::uint64_t y = 1;
    std::uint64_t z = 1;
    bool foldable = false;
};

/// A sequence of device work: record, submit, wait; then record again. Commands run as if one after the other: barriers
/// follow from what each command reads and writes, and a stream sees what earlier submitted streams wrote. One thread
/// at a time may use a stream. Waits for its work when it ends.
class Stream {
  public:
    explicit Stream(Device& device, Profiler* profiler = nullptr);
    ~Stream();
    Stream(const Stream&) = delete;
    Stream& operator=(const Stream&) = delete;

    /// Runs a kernel over `threads`; nothing if there are none. `bindings` are in the order of the shader's binding
    /// numbers. Throws ShaderError if their number or the push constants' size is wrong, DeviceLimitError if a binding
    /// is over the device's max_storage_range (bind BufferRanges of a tiled buffer instead) or there are more threads
    /// than a kernel can count.
    void dispatch(const Kernel& kernel, Threads threads, std::initializer_list<BufferRange> bindings) {
        dispatch_bytes(kernel, threads, {bindings.begin(), bindings.size()}, {});
    }
    template <typename Push>
    void dispatch(const Kernel& kernel, Threads threads, std::initializer_list<BufferRange> bindings,
                  const Push& push) {
        static_assert(std::is_trivially_copyable_v<Push>);
        dispatch_bytes(kernel, threads, {bindings.begin(), bindings.size()}, std::as_bytes(std::span(&push, 1)));
    }
    void dispatch_bytes(const Kernel& kernel, Threads threads, std::span<const BufferRange> bindings,
                        std::span<const std::byte> push);

    /// Copies host values into `target` at byte `offset`; `values` may end as soon as this returns.
    template <typename T>
    void upload(Buffer& target, std::span<const T> values, std::size_t offset = 0) {
        static_assert(std::is_trivially_copyable_v<T>);
        upload_bytes(target, std::as_bytes(values), offset);
    }
    /// Copies device values to the host: they are in `values`, which must live until then, after wait().
    template <typename T>
    void download(const Buffer& source, std::span<T> values, std::size_t offset = 0) {
        static_assert(std::is_trivially_copyable_v<T>);
        download_bytes(source, std::as_writable_bytes(values), offset);
    }
    /// Copies `bytes` bytes between two buffers.
    void copy(const Buffer& source, std::size_t source_offset, const Buffer& target, std::size_t target_offset,
              std::size_t bytes);
    /// Sets every 4 bytes of the buffer to `word`.
    void fill(const Buffer& target, std::uint32_t word);

    /// Hands the recorded work to the device and returns at once; nothing may be recorded until wait().
    void submit();
    /// Waits until the submitted work is done and downloads have arrived. Throws DeviceLostError if the device was
    /// lost.
    void wait();
    /// submit() and wait().
    void finish();

    /// All barriers recorded since the stream was last submitted and waited for.
    const std::vector<Barrier>& barriers() const { return barriers_; }

  private:
    struct Staging {
        Buffer buffer;
        std::size_t used = 0;
    };
    struct Download {
        const std::byte* source;
        std::span<std::byte> target;
    };
    struct Timing {
        std::shared_ptr<const Kernel::Program> program;
        std::uint32_t first_query;
    };

    void begin();
    void release();
    void use(const Buffer& buffer);
    void order(std::span<const Access> accesses);
    void upload_bytes(Buffer& target, std::span<const std::byte> data, std::size_t offset);
    void download_bytes(const Buffer& source, std::span<std::byte> data, std::size_t offset);
    std::pair<Staging*, std::size_t> stage(std::vector<Staging>& blocks, std::size_t bytes, BufferMemory memory);
    VkDescriptorSet allocate_set(VkDescriptorSetLayout layout);
    void bind(const Kernel& kernel, std::span<const BufferRange> bindings);
    void add_descriptor_pool();
    void start_timing(const Kernel& kernel);
    void stop_timing();
    void collect_timings();

    Device& device_;
    Profiler* profiler_;
    VkCommandPool pool_ = VK_NULL_HANDLE;
    VkCommandBuffer commands_ = VK_NULL_HANDLE;
    VkFence fence_ = VK_NULL_HANDLE;
    bool recording_ = false;
    bool submitted_ = false;
    HazardTracker hazards_;
    std::vector<Barrier> barriers_;
    std::vector<VkDescriptorPool> descriptor_pools_;
    std::size_t current_pool_ = 0;
    std::vector<Staging> uploads_, readbacks_;
    std::vector<Download> downloads_;
    std::set<std::shared_ptr<Buffer::Resource>> buffers_;
    std::set<std::shared_ptr<const Kernel::Program>> programs_;
    VkQueryPool queries_ = VK_NULL_HANDLE;
    std::vector<Timing> timings_;
    bool timing_open_ = false;
};

}  // namespace exemplar
