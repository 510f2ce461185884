#pragma once

#include <vulkan/vulkan_core.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <set>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "gpu/runtime/device/commands.h"
#include "gpu/runtime/device/staging_pool.h"
#include "gpu/runtime/kernels/kernel.h"
#include "gpu/runtime/kernels/threads.h"
#include "gpu/runtime/record/buffer.h"
#include "gpu/runtime/record/descriptors.h"
#include "gpu/runtime/record/hazards.h"
#include "gpu/runtime/record/image_layout.h"
#include "gpu/runtime/record/pass.h"
#include "gpu/runtime/record/profiler.h"
#include "gpu/runtime/record/timestamps.h"

namespace exemplar {

/// Bytes of a buffer from `offset` on, and their destination on the host.
struct HostReadback {
    std::size_t offset;
    std::span<std::byte> target;
};

/// The same with the buffer.
struct BufferReadback {
    const Buffer* source;
    std::size_t offset;
    std::span<std::byte> target;
};

/// A sequence of device work: record, submit, wait, then record again. Commands behave as if run one after the
/// other: barriers are derived from their reads and writes. Writes of streams submitted earlier are visible. One
/// thread at a time may use a stream. The destructor waits for submitted work.
class Stream {
  public:
    explicit Stream(Device& device, Profiler* profiler = nullptr);
    ~Stream();
    Stream(const Stream&) = delete;
    Stream& operator=(const Stream&) = delete;

    /// Records a kernel over `threads`, or nothing if there are none. `bindings` are in the order of the shader's
    /// binding numbers. Throws ShaderError if their number or the size of the push constants is wrong,
    /// DeviceLimitError if a binding exceeds the device's max_storage_range or max_texels (bind BufferRanges of a
    /// tiled buffer instead) or there are too many threads (see workgroups).
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

    /// Records a kernel whose workgroup counts the device reads from `arguments` at byte `offset` (a multiple of 4):
    /// a VkDispatchIndirectCommand within the device's limits. Throws as dispatch.
    void dispatch_indirect(const Kernel& kernel, const Buffer& arguments, std::size_t offset,
                           std::initializer_list<BufferRange> bindings) {
        dispatch_indirect_bytes(kernel, arguments, offset, {bindings.begin(), bindings.size()}, {});
    }
    template <typename Push>
    void dispatch_indirect(const Kernel& kernel, const Buffer& arguments, std::size_t offset,
                           std::initializer_list<BufferRange> bindings, const Push& push) {
        static_assert(std::is_trivially_copyable_v<Push>);
        dispatch_indirect_bytes(kernel, arguments, offset, {bindings.begin(), bindings.size()},
                                std::as_bytes(std::span(&push, 1)));
    }
    void dispatch_indirect_bytes(const Kernel& kernel, const Buffer& arguments, std::size_t offset,
                                 std::span<const BufferRange> bindings, std::span<const std::byte> push);

    /// Records a pass. Throws ShaderError and DeviceLimitError as dispatch.
    void render(const Pass& pass);
    /// Changes an image's layout; its contents survive unless `from` is VK_IMAGE_LAYOUT_UNDEFINED. Images are not
    /// tracked: `transition` gives the stages and accesses to wait for.
    void transition(VkImage image, VkImageAspectFlags aspect, VkImageLayout from, VkImageLayout to,
                    const Transition& transition);
    /// Copies the first mip of an image in VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL to the start of a buffer, row by row
    /// without gaps. The caller must have made its contents visible to copies.
    void copy_image(VkImage image, VkImageAspectFlags aspect, VkExtent2D extent, std::size_t texel_bytes,
                    const Buffer& target);
    /// The same to the host, for texels of target.size() / (width * height) bytes, a multiple of 4. They arrive at
    /// wait(), so `target` must live until then.
    void download_image(VkImage image, VkImageAspectFlags aspect, VkExtent2D extent, std::span<std::byte> target);

    /// Copies the color of `source`, `extent` pixels in VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, into `part` of
    /// `target`, in VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL; scales if the sizes differ. The caller must have made the
    /// source visible.
    void blit(VkImage source, VkExtent2D extent, VkImage target, VkRect2D part);

    /// Copies host values into `target` at byte `offset`; `values` is not used after the return.
    template <typename T>
    void upload(Buffer& target, std::span<const T> values, std::size_t offset = 0) {
        static_assert(std::is_trivially_copyable_v<T>);
        upload_bytes(target, std::as_bytes(values), offset);
    }
    /// Uploads `bytes` bytes that the callback computes: calls `write` once, before it returns, with a
    /// std::span<std::byte> of write-only memory to fill. Otherwise like upload().
    template <typename Write>
    void upload_with(Buffer& target, std::size_t bytes, std::size_t offset, Write&& write) {
        const UploadTarget place = begin_upload(target, offset, bytes);
        write(place.memory);
        end_upload(place, target, offset);
    }
    /// Copies device values to the host. They arrive in `values` at wait(), so `values` must live until then.
    template <typename T>
    void download(const Buffer& source, std::span<T> values, std::size_t offset = 0) {
        static_assert(std::is_trivially_copyable_v<T>);
        download_bytes(source, std::as_writable_bytes(values), offset);
    }
    /// Copies `bytes` bytes between two buffers, or between two parts of one that do not overlap.
    void copy(const Buffer& source, std::size_t source_offset, const Buffer& target, std::size_t target_offset,
              std::size_t bytes);
    /// Sets every 4 bytes of the buffer to `word`.
    void fill(const Buffer& target, std::uint32_t word);

    /// Records into a command buffer of the caller's from now on, which must be recording, outside of a render pass,
    /// and belong to the device's queue family. Begins with a barrier: what the caller recorded or submitted before is
    /// seen. Nothing may be recorded or in flight. If a call throws afterwards, what was recorded before stays valid.
    void record_into(VkCommandBuffer commands);
    /// Ends that with a barrier: what the caller records or submits next sees the results. The caller submits. Then
    /// retire() must be called, once the device has finished the commands or the caller has dropped them.
    void end_recording();
    /// Delivers downloads and frees what the caller's commands needed.
    void retire();

    /// Drops what was recorded and not submitted, for example after a call has thrown, so that the stream can be used
    /// again. Not for commands of the caller's.
    void discard();
    /// Submits the recorded work and returns at once; nothing may be recorded until wait(). Returns the submission's
    /// ticket for Device::wait.
    Ticket submit(const SubmitOrder& order = {});
    /// Waits until the submitted work is done and downloads have arrived. Throws DeviceLostError if the device was
    /// lost.
    void wait();
    /// submit() and wait().
    void finish();
    /// download() and finish() in one; reads mapped buffers directly, without a staging copy.
    template <typename T>
    void fetch(const Buffer& source, std::span<T> values) {
        static_assert(std::is_trivially_copyable_v<T>);
        const HostReadback whole{0, std::as_writable_bytes(values)};
        fetch(source, std::span(&whole, 1));
    }
    /// The same for parts of a buffer.
    void fetch(const Buffer& source, std::span<const HostReadback> parts);
    /// The same for parts of several buffers.
    void fetch(std::span<const BufferReadback> parts);

    /// Returns all barriers of the current recording, or of the last one if none is in progress.
    const std::vector<Barrier>& barriers() const { return barriers_; }

  private:
    struct Download {
        const std::byte* source;
        std::span<std::byte> target;
    };
    using StagingBlocks = std::vector<std::unique_ptr<StagingBlock>>;
    // Memory that the host writes an upload to: that of the target itself, or staging memory.
    struct UploadTarget {
        std::span<std::byte> memory;
        StagingBlock* staging;  // null for the target itself
        std::size_t offset;
    };
    // Regions that one copy command will copy from one buffer to another.
    struct Copies {
        VkBuffer source = VK_NULL_HANDLE, target = VK_NULL_HANDLE;
        VkDeviceSize end = 0;  // of the last byte written
        std::vector<VkBufferCopy> regions{};
    };

    enum class External { none, recording, recorded };
    void start();
    void begin();
    VkCommandBuffer commands() const { return external_ ? external_ : commands_.handle(); }
    void deliver();
    void release();
    static void check_bytes(const Buffer& buffer, std::size_t offset, std::size_t bytes);
    void use(const Buffer& buffer);
    void prepare(const Kernel& kernel, std::span<const BufferRange> bindings, std::span<const std::byte> push,
                 std::vector<Access> accesses);
    void order(std::span<const Access> accesses);
    void upload_bytes(Buffer& target, std::span<const std::byte> data, std::size_t offset);
    void download_bytes(const Buffer& source, std::span<std::byte> data, std::size_t offset);
    void add_copy(VkBuffer source, VkBuffer target, const VkBufferCopy& region, std::span<const Access> accesses);
    bool extends_copies(VkBuffer source, VkBuffer target, const VkBufferCopy& region) const;
    void record_copies();
    std::pair<StagingBlock*, std::size_t> stage(StagingBlocks& blocks, std::size_t bytes, StagingUse use);
    UploadTarget begin_upload(const Buffer& target, std::size_t offset, std::size_t bytes);
    void end_upload(const UploadTarget& place, Buffer& target, std::size_t offset);

    Device& device_;
    HazardTracker hazards_;
    std::vector<Barrier> barriers_;
    Copies copies_;
    StagingBlocks uploads_, readbacks_;
    std::vector<Download> downloads_;
    std::set<std::shared_ptr<Buffer::Resource>> buffers_;
    std::set<std::shared_ptr<const Program>> programs_;
    Descriptors descriptors_;
    Timestamps timestamps_;
    Commands commands_;
    VkCommandBuffer external_ = VK_NULL_HANDLE;  // the caller's
    External external_state_ = External::none;
};

/// Returns a buffer that holds `values` once the work that `stream` records next runs. Unlike Buffer::of, it costs no
/// submission of its own.
template <typename T>
Buffer uploaded(Device& device, Stream& stream, std::span<const T> values) {
    Buffer buffer(device, values.size_bytes());
    stream.upload(buffer, values);
    return buffer;
}

}  // namespace exemplar
