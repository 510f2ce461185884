#include "gpu/runtime/stream.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>

#include "gpu/runtime/device.h"
#include "gpu/runtime/errors.h"

namespace exemplar {
namespace {

constexpr std::size_t k_staging_block = std::size_t{4} << 20;
constexpr std::size_t k_staging_alignment = 16;

Access access_of(const ReflectedBinding& binding, const BufferRange& range) {
    return {.buffer = range.buffer->handle(),
            .stage = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
            .reads = binding.type == BindingType::texels ? VK_ACCESS_2_SHADER_SAMPLED_READ_BIT
                     : binding.reads                     ? VK_ACCESS_2_SHADER_STORAGE_READ_BIT
                                                         : VK_ACCESS_2_NONE,
            .writes = binding.writes ? VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT : VK_ACCESS_2_NONE};
}

Access copy_read(const Buffer& buffer) {
    return {.buffer = buffer.handle(),
            .stage = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
            .reads = VK_ACCESS_2_TRANSFER_READ_BIT};
}

Access copy_write(const Buffer& buffer) {
    return {.buffer = buffer.handle(),
            .stage = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
            .writes = VK_ACCESS_2_TRANSFER_WRITE_BIT};
}

void check_bytes(const Buffer& buffer, std::size_t offset, std::size_t bytes) {
    if (!buffer) throw DeviceError("a copy needs a buffer that has memory");
    if (offset > buffer.bytes() || bytes > buffer.bytes() - offset)
        throw DeviceError(
            fmt::format("bytes {} to {} are outside a buffer of {} bytes", offset, offset + bytes, buffer.bytes()));
}

}  // namespace

Stream::Stream(Device& device, Profiler* profiler)
    : device_(device), descriptors_(device), timestamps_(device, profiler), commands_(device) {}

Stream::~Stream() {
    try {
        commands_.wait();
    } catch (const DeviceError&) {
        // A lost device has nothing under way.
    }
    release();
}

void Stream::begin() {
    if (commands_.state() == Commands::State::idle) barriers_.clear();
    commands_.begin();
}

void Stream::use(const Buffer& buffer) {
    if (buffers_.insert(buffer.resource()).second) ++buffer.resource()->streams;
}

void Stream::order(std::span<const Access> accesses) {
    const std::vector<Barrier> barriers = hazards_.before(accesses);
    if (barriers.empty()) return;
    std::vector<VkBufferMemoryBarrier2> infos;
    infos.reserve(barriers.size());
    for (const Barrier& barrier : barriers)
        infos.push_back({.sType = VK_STRUCTURE_TYPE_BUFFER_MEMORY_BARRIER_2,
                         .pNext = nullptr,
                         .srcStageMask = barrier.source_stage,
                         .srcAccessMask = barrier.source_access,
                         .dstStageMask = barrier.target_stage,
                         .dstAccessMask = barrier.target_access,
                         .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                         .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                         .buffer = barrier.buffer,
                         .offset = 0,
                         .size = VK_WHOLE_SIZE});
    auto dependency = empty_structure<VkDependencyInfo>(VK_STRUCTURE_TYPE_DEPENDENCY_INFO);
    dependency.bufferMemoryBarrierCount = static_cast<std::uint32_t>(infos.size());
    dependency.pBufferMemoryBarriers = infos.data();
    vkCmdPipelineBarrier2(commands_.handle(), &dependency);
    barriers_.insert(barriers_.end(), barriers.begin(), barriers.end());
}

void Stream::dispatch_bytes(const Kernel& kernel, Threads threads, std::span<const BufferRange> ranges,
                            std::span<const std::byte> push) {
    const Reflection& reflection = kernel.reflection();
    if (push.size() != reflection.push_bytes)
        throw ShaderError(fmt::format("kernel {} takes {} bytes of push constants, not {}", kernel.name(),
                                      reflection.push_bytes, push.size()));
    descriptors_.check_bindings(kernel, ranges);
    if (threads.x == 0 || threads.y == 0 || threads.z == 0) return;
    const std::array<std::uint32_t, 3> groups = workgroups(kernel, threads, device_.info());
    begin();
    std::vector<Access> accesses;
    for (std::size_t i = 0; i < ranges.size(); ++i) {
        accesses.push_back(access_of(reflection.bindings[i], ranges[i]));
        use(*ranges[i].buffer);
    }
    programs_.insert(kernel.program());
    order(accesses);
    vkCmdBindPipeline(commands_.handle(), VK_PIPELINE_BIND_POINT_COMPUTE, kernel.program()->pipeline.get());
    descriptors_.bind(commands_.handle(), kernel, ranges);
    if (!push.empty())
        vkCmdPushConstants(commands_.handle(), kernel.program()->layout.get(), VK_SHADER_STAGE_COMPUTE_BIT, 0,
                           static_cast<std::uint32_t>(push.size()), push.data());
    timestamps_.start(commands_.handle(), kernel);
    vkCmdDispatch(commands_.handle(), groups[0], groups[1], groups[2]);
    timestamps_.stop(commands_.handle());
}

std::pair<Stream::Staging*, std::size_t> Stream::stage(std::vector<Staging>& blocks, std::size_t bytes,
                                                       BufferMemory memory) {
    const std::size_t padded = (bytes + k_staging_alignment - 1) / k_staging_alignment * k_staging_alignment;
    auto block = std::ranges::find_if(blocks, [&](const Staging& b) { return b.buffer.bytes() - b.used >= padded; });
    if (block == blocks.end())
        block = blocks.insert(block, {Buffer(device_, std::max(k_staging_block, padded), memory)});
    const std::size_t offset = block->used;
    block->used += padded;
    return {&*block, offset};
}

Stream::UploadPlace Stream::begin_upload(const Buffer& target, std::size_t offset, std::size_t bytes) {
    check_bytes(target, offset, bytes);
    if (bytes == 0) return {{}, nullptr, 0};
    // Nobody uses the target yet, so that the host may write it where it lies.
    if (target.resource()->mapped && target.resource()->streams == 0)
        return {{target.resource()->mapped + offset, bytes}, nullptr, 0};
    begin();
    const auto [block, first] = stage(uploads_, bytes, BufferMemory::upload);
    return {{block->buffer.resource()->mapped + first, bytes}, block, first};
}

void Stream::end_upload(const UploadPlace& place, Buffer& target, std::size_t offset) {
    if (place.staging) copy(place.staging->buffer, place.offset, target, offset, place.memory.size());
}

void Stream::upload_bytes(Buffer& target, std::span<const std::byte> data, std::size_t offset) {
    upload_with(target, data.size(), offset,
                [&](std::span<std::byte> memory) { std::ranges::copy(data, memory.begin()); });
}

void Stream::download_bytes(const Buffer& source, std::span<std::byte> data, std::size_t offset) {
    check_bytes(source, offset, data.size());
    if (data.empty()) return;
    begin();
    const auto [block, begin_byte] = stage(readbacks_, data.size(), BufferMemory::readback);
    copy(source, offset, block->buffer, begin_byte, data.size());
    downloads_.push_back({block->buffer.resource()->mapped + begin_byte, data});
}

void Stream::copy(const Buffer& source, std::size_t source_offset, const Buffer& target, std::size_t target_offset,
                  std::size_t bytes) {
    check_bytes(source, source_offset, bytes);
    check_bytes(target, target_offset, bytes);
    if (bytes == 0) return;
    const bool apart = source_offset + bytes <= target_offset || target_offset + bytes <= source_offset;
    if (source.handle() == target.handle() && !apart)
        throw DeviceError(fmt::format("a copy of {} bytes from byte {} to byte {} of one buffer overlaps itself", bytes,
                                      source_offset, target_offset));
    begin();
    use(source);
    use(target);
    order(std::array{copy_read(source), copy_write(target)});
    const VkBufferCopy region{source_offset, target_offset, bytes};
    vkCmdCopyBuffer(commands_.handle(), source.handle(), target.handle(), 1, &region);
}

void Stream::fill(const Buffer& target, std::uint32_t word) {
    check_bytes(target, 0, target.bytes());
    begin();
    use(target);
    order(std::array{copy_write(target)});
    vkCmdFillBuffer(commands_.handle(), target.handle(), 0, VK_WHOLE_SIZE, word);
}

void Stream::submit() {
    begin();
    try {
        commands_.submit();
    } catch (const DeviceError&) {
        release();
        throw;
    }
}

void Stream::wait() {
    if (commands_.state() != Commands::State::submitted) return;
    commands_.wait();
    for (const Download& download : downloads_)
        std::memcpy(download.target.data(), download.source, download.target.size());
    timestamps_.collect();
    release();
}

void Stream::finish() {
    submit();
    wait();
}

void Stream::fetch_bytes(const Buffer& source, std::span<std::byte> data) {
    const bool mapped = source && source.resource()->mapped;
    if (!mapped) download_bytes(source, data, 0);
    finish();
    if (mapped) source.read(data, 0);
}

// Lets go of everything that finished work used.
void Stream::release() {
    for (const std::shared_ptr<Buffer::Resource>& buffer : buffers_) --buffer->streams;
    buffers_.clear();
    programs_.clear();
    downloads_.clear();
    timestamps_.clear();
    descriptors_.reset();
    hazards_.reset();
    for (Staging& block : uploads_) block.used = 0;
    for (Staging& block : readbacks_) block.used = 0;
}

}  // namespace exemplar
