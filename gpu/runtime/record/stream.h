#pragma once

#include <volk.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <set>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "gpu/runtime/record/buffer.h"
#include "gpu/runtime/device/commands.h"
#include "gpu/runtime/record/descriptors.h"
#include "gpu/runtime/record/hazards.h"
#include "gpu/runtime/record/image_layout.h"
#include "gpu/runtime/kernels/kernel.h"
#include "gpu/runtime/record/pass.h"
#include "gpu/runtime/record/profiler.h"
#include "gpu/runtime/kernels/threads.h"
#include "gpu/runtime/record/timestamps.h"

namespace exemplar {

/// Bytes of a buffer from `offset` on, and where they go on the host.
struct HostPart {
    std::size_t offset;
    std::span<std::byte> target;
};

/// The same of any buffer.
struct BufferPart {
    const Buffer* source;
    std::size_t offset;
    std::span<std::byte> target;
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
    /// is over the device's max_storage_range or max_texels (bind BufferRanges of a tiled buffer instead) or there are
    /// more threads than a kernel can count.
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

    /// Runs a kernel over as many workgroups as the device finds in `arguments` at byte `offset` (a multiple of 4): a
    /// VkDispatchIndirectCommand of no more than the device allows. Throws as dispatch.
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

    /// Draws. Throws ShaderError and DeviceLimitError as dispatch.
    void render(const Pass& pass);
    /// Changes an image's layout; its contents survive unless `from` is VK_IMAGE_LAYOUT_UNDEFINED. Images are not
    /// tracked: `transition` says what is waited for.
    void transition(VkImage image, VkImageAspectFlags aspect, VkImageLayout from, VkImageLayout to,
                    const Transition& transition);
    /// Copies the first mip of an image in VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL to the start of a buffer, row by row
    /// without gaps. The caller has made its contents visible to copies.
    void copy_image(VkImage image, VkImageAspectFlags aspect, VkExtent2D extent, std::size_t texel_bytes,
                    const Buffer& target);

    /// Fills a part of an image in VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL with all of another's color, of `extent` pixels
    /// and in VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL; scales it if sizes differ. The caller has made the source visible.
    void blit(VkImage source, VkExtent2D extent, VkImage target, VkRect2D part);

    /// Copies host values into `target` at byte `offset`; `values` may end as soon as this returns.
    template <typename T>
    void upload(Buffer& target, std::span<const T> values, std::size_t offset = 0) {
        static_assert(std::is_trivially_copyable_v<T>);
        upload_bytes(target, std::as_bytes(values), offset);
    }
    /// As upload, of `bytes` bytes that `write` puts into the std::span<std::byte> it is called with, at once: for
    /// values that are computed on the way. The span is write-only memory.
    template <typename Write>
    void upload_with(Buffer& target, std::size_t bytes, std::size_t offset, Write&& write) {
        const UploadPlace place = begin_upload(target, offset, bytes);
        write(place.memory);
        end_upload(place, target, offset);
    }
    /// Copies device values to the host: they are in `values`, which must live until then, after wait().
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

    /// Hands the recorded work to the device and returns at once; nothing may be recorded until wait().
    void submit(const SubmitOrder& order = {});
    /// Waits until the submitted work is done and downloads have arrived. Throws DeviceLostError if the device was
    /// lost.
    void wait();
    /// submit() and wait().
    void finish();
    /// download() and finish(), without a copy between where the host sees the buffer's memory.
    template <typename T>
    void fetch(const Buffer& source, std::span<T> values) {
        static_assert(std::is_trivially_copyable_v<T>);
        const HostPart whole{0, std::as_writable_bytes(values)};
        fetch(source, std::span(&whole, 1));
    }
    /// The same of parts of a buffer.
    void fetch(const Buffer& source, std::span<const HostPart> parts);
    /// The same of parts of several buffers.
    void fetch(std::span<const BufferPart> parts);

    /// All barriers of the current recording, or of the last one while there is none.
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
    // Where the host writes what is uploaded: into the target itself, or into staging memory.
    struct UploadPlace {
        std::span<std::byte> memory;
        Staging* staging;  // null for the target itself
        std::size_t offset;
    };

    void begin();
    void release();
    void use(const Buffer& buffer);
    void prepare(const Kernel& kernel, std::span<const BufferRange> bindings, std::span<const std::byte> push,
                 std::vector<Access> accesses);
    void order(std::span<const Access> accesses);
    void upload_bytes(Buffer& target, std::span<const std::byte> data, std::size_t offset);
    void download_bytes(const Buffer& source, std::span<std::byte> data, std::size_t offset);
    std::pair<Staging*, std::size_t> stage(std::vector<Staging>& blocks, std::size_t bytes, BufferMemory memory);
    UploadPlace begin_upload(const Buffer& target, std::size_t offset, std::size_t bytes);
    void end_upload(const UploadPlace& place, Buffer& target, std::size_t offset);

    Device& device_;
    HazardTracker hazards_;
    std::vector<Barrier> barriers_;
    std::vector<Staging> uploads_, readbacks_;
    std::vector<Download> downloads_;
    std::set<std::shared_ptr<Buffer::Resource>> buffers_;
    std::set<std::shared_ptr<const Program>> programs_;
    Descriptors descriptors_;
    Timestamps timestamps_;
    Commands commands_;
};

}  // namespace exemplar
