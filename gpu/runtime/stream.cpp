#include "gpu/runtime/stream.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <limits>

#include "gpu/runtime/device.h"
#include "gpu/runtime/errors.h"

namespace exemplar {
namespace {

constexpr std::uint32_t k_sets_per_pool = 256;
constexpr std::uint32_t k_bindings_per_pool = 8 * k_sets_per_pool;
constexpr std::uint32_t k_timed_dispatches = 1024;
constexpr std::size_t k_staging_block = std::size_t{4} << 20;

std::uint64_t group_count(std::uint64_t threads, std::uint32_t local_size) {
    return (threads + local_size - 1) / local_size;
}

// The smallest box of groups that holds `groups` in rows of equal length.
std::array<std::uint64_t, 3> fold(std::uint64_t groups, const std::array<std::uint32_t, 3>& limit) {
    const std::uint64_t rows = group_count(groups, limit[0]);
    const std::uint64_t slices = group_count(rows, limit[1]);
    const std::uint64_t rows_per_slice = group_count(rows, static_cast<std::uint32_t>(slices));
    const std::uint64_t total_rows = slices * rows_per_slice;
    return {(groups + total_rows - 1) / total_rows, rows_per_slice, slices};
}

std::array<std::uint32_t, 3> groups_of(const Kernel& kernel, const Threads& threads, const DeviceInfo& info) {
    const std::array<std::uint32_t, 3> local = kernel.local_size();
    std::array<std::uint64_t, 3> groups{group_count(threads.x, local[0]), group_count(threads.y, local[1]),
                                        group_count(threads.z, local[2])};
    if (threads.foldable) groups = fold(groups[0], info.max_groups);
    for (std::size_t axis = 0; axis < 3; ++axis)
        if (groups[axis] > info.max_groups[axis])
            throw DeviceLimitError(
                fmt::format("kernel {} needs {} workgroups along axis {}, over the limit of {} of device '{}'",
                            kernel.name(), groups[axis], axis, info.max_groups[axis], info.name),
                groups[axis], info.max_groups[axis]);
    constexpr std::uint64_t k_limit = std::numeric_limits<std::uint32_t>::max();
    if (threads.foldable && groups[0] * groups[1] * groups[2] * local[0] > k_limit)
        throw DeviceLimitError(
            fmt::format("kernel {} over {} threads: its indices have 32 bits; tile the work", kernel.name(), threads.x),
            threads.x, k_limit);
    return {static_cast<std::uint32_t>(groups[0]), static_cast<std::uint32_t>(groups[1]),
            static_cast<std::uint32_t>(groups[2])};
}

void check_binding(const Kernel& kernel, const ReflectedBinding& binding, const BufferRange& range,
                   const DeviceInfo& info) {
    const std::string start = fmt::format("kernel {}: buffer '{}': ", kernel.name(), binding.name);
    if (!*range.buffer) throw ShaderError(start + "it has no memory");
    if (range.offset > range.buffer->bytes() || range.bytes > range.buffer->bytes() - range.offset)
        throw ShaderError(fmt::format("{}bytes {} to {} are outside its {} bytes", start, range.offset,
                                      range.offset + range.bytes, range.buffer->bytes()));
    if (range.offset % info.storage_alignment != 0)
        throw DeviceLimitError(fmt::format("{}offset {} is no multiple of {}, as device '{}' needs it", start,
                                           range.offset, info.storage_alignment, info.name),
                               range.offset, info.storage_alignment);
    if (range.bytes > info.max_storage_range)
        throw DeviceLimitError(
            fmt::format("{}{} are over the limit of {} per binding of device '{}'; tile the work", start,
                        format_bytes(range.bytes), format_bytes(info.max_storage_range), info.name),
            range.bytes, info.max_storage_range);
}

Access access_of(const ReflectedBinding& binding, const BufferRange& range) {
    return {.buffer = range.buffer->handle(),
            .stage = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
            .reads = binding.reads ? VK_ACCESS_2_SHADER_STORAGE_READ_BIT : VK_ACCESS_2_NONE,
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

Stream::Stream(Device& device, Profiler* profiler) : device_(device), profiler_(profiler) {
    const VkCommandPoolCreateInfo pool{.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                       .pNext = nullptr,
                                       .flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT,
                                       .queueFamilyIndex = device.queue_family()};
    check(vkCreateCommandPool(device.handle(), &pool, nullptr, &pool_), "make a command pool");
    const VkCommandBufferAllocateInfo allocate{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                               .pNext = nullptr,
                                               .commandPool = pool_,
                                               .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                               .commandBufferCount = 1};
    check(vkAllocateCommandBuffers(device.handle(), &allocate, &commands_), "make a command buffer");
    const VkFenceCreateInfo fence{.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO, .pNext = nullptr, .flags = 0};
    check(vkCreateFence(device.handle(), &fence, nullptr, &fence_), "make a fence");
}

Stream::~Stream() {
    if (submitted_) vkWaitForFences(device_.handle(), 1, &fence_, VK_TRUE, UINT64_MAX);
    release();
    for (VkDescriptorPool pool : descriptor_pools_) vkDestroyDescriptorPool(device_.handle(), pool, nullptr);
    vkDestroyQueryPool(device_.handle(), queries_, nullptr);
    vkDestroyFence(device_.handle(), fence_, nullptr);
    vkDestroyCommandPool(device_.handle(), pool_, nullptr);
}

void Stream::begin() {
    if (submitted_)
        throw DeviceError("a stream was recorded to before its submitted work was waited for; call wait() first");
    if (recording_) return;
    const VkCommandBufferBeginInfo info{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                        .pNext = nullptr,
                                        .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT,
                                        .pInheritanceInfo = nullptr};
    check(vkBeginCommandBuffer(commands_, &info), "record commands");
    barriers_.clear();
    recording_ = true;
}

void Stream::use(const Buffer& buffer) {
    if (buffers_.insert(buffer.resource()).second) ++buffer.resource()->streams;
}

void Stream::order(std::span<const Access> accesses) {
    const std::vector<Barrier> barriers = hazards_.before(accesses);
    if (barriers.empty()) return;
    std::vector<VkBufferMemoryBarrier2> infos;
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
    vkCmdPipelineBarrier2(commands_, &dependency);
    barriers_.insert(barriers_.end(), barriers.begin(), barriers.end());
}

void Stream::dispatch_bytes(const Kernel& kernel, Threads threads, std::span<const BufferRange> bindings,
                            std::span<const std::byte> push) {
    const Reflection& reflection = kernel.reflection();
    if (bindings.size() != reflection.bindings.size())
        throw ShaderError(fmt::format("kernel {} binds {} buffers, not {}", kernel.name(), reflection.bindings.size(),
                                      bindings.size()));
    if (push.size() != reflection.push_bytes)
        throw ShaderError(fmt::format("kernel {} takes {} bytes of push constants, not {}", kernel.name(),
                                      reflection.push_bytes, push.size()));
    if (threads.x == 0 || threads.y == 0 || threads.z == 0) return;
    const std::array<std::uint32_t, 3> groups = groups_of(kernel, threads, device_.info());
    std::vector<Access> accesses;
    for (std::size_t i = 0; i < bindings.size(); ++i) {
        check_binding(kernel, reflection.bindings[i], bindings[i], device_.info());
        accesses.push_back(access_of(reflection.bindings[i], bindings[i]));
    }
    begin();
    for (const BufferRange& range : bindings) use(*range.buffer);
    programs_.insert(kernel.program());
    order(accesses);
    vkCmdBindPipeline(commands_, VK_PIPELINE_BIND_POINT_COMPUTE, kernel.program()->pipeline);
    bind(kernel, bindings);
    if (!push.empty())
        vkCmdPushConstants(commands_, kernel.program()->layout, VK_SHADER_STAGE_COMPUTE_BIT, 0,
                           static_cast<std::uint32_t>(push.size()), push.data());
    start_timing(kernel);
    vkCmdDispatch(commands_, groups[0], groups[1], groups[2]);
    stop_timing();
}

void Stream::bind(const Kernel& kernel, std::span<const BufferRange> bindings) {
    if (bindings.empty()) return;
    const VkDescriptorSet set = allocate_set(kernel.program()->set_layout);
    std::vector<VkDescriptorBufferInfo> infos(bindings.size());
    std::vector<VkWriteDescriptorSet> writes(bindings.size());
    for (std::size_t i = 0; i < bindings.size(); ++i) {
        // An empty range still needs an address: buffers are never smaller than 16 bytes.
        const bool rest = bindings[i].offset + bindings[i].bytes == bindings[i].buffer->bytes();
        infos[i] = {bindings[i].buffer->handle(), bindings[i].offset,
                    bindings[i].bytes && !rest ? bindings[i].bytes : VK_WHOLE_SIZE};
        writes[i] = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                     .pNext = nullptr,
                     .dstSet = set,
                     .dstBinding = kernel.reflection().bindings[i].binding,
                     .dstArrayElement = 0,
                     .descriptorCount = 1,
                     .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                     .pImageInfo = nullptr,
                     .pBufferInfo = &infos[i],
                     .pTexelBufferView = nullptr};
    }
    vkUpdateDescriptorSets(device_.handle(), static_cast<std::uint32_t>(writes.size()), writes.data(), 0, nullptr);
    vkCmdBindDescriptorSets(commands_, VK_PIPELINE_BIND_POINT_COMPUTE, kernel.program()->layout, 0, 1, &set, 0,
                            nullptr);
}

void Stream::add_descriptor_pool() {
    const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, k_bindings_per_pool};
    const VkDescriptorPoolCreateInfo info{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                          .pNext = nullptr,
                                          .flags = 0,
                                          .maxSets = k_sets_per_pool,
                                          .poolSizeCount = 1,
                                          .pPoolSizes = &size};
    VkDescriptorPool pool = VK_NULL_HANDLE;
    check(vkCreateDescriptorPool(device_.handle(), &info, nullptr, &pool), "make a descriptor pool");
    descriptor_pools_.push_back(pool);
}

VkDescriptorSet Stream::allocate_set(VkDescriptorSetLayout layout) {
    VkDescriptorSet set = VK_NULL_HANDLE;
    // A full pool refuses; the next one is fresh and never does.
    for (bool fresh = false; !fresh; ++current_pool_) {
        fresh = current_pool_ == descriptor_pools_.size();
        if (fresh) add_descriptor_pool();
        const VkDescriptorSetAllocateInfo info{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                               .pNext = nullptr,
                                               .descriptorPool = descriptor_pools_[current_pool_],
                                               .descriptorSetCount = 1,
                                               .pSetLayouts = &layout};
        const VkResult result = vkAllocateDescriptorSets(device_.handle(), &info, &set);
        if (result == VK_SUCCESS) return set;
        if (fresh || (result != VK_ERROR_OUT_OF_POOL_MEMORY && result != VK_ERROR_FRAGMENTED_POOL))
            check(result, "allocate a descriptor set");
    }
    return set;
}

std::pair<Stream::Staging*, std::size_t> Stream::stage(std::vector<Staging>& blocks, std::size_t bytes,
                                                       BufferMemory memory) {
    for (Staging& block : blocks)
        if (block.buffer.bytes() - block.used >= bytes) {
            const std::size_t offset = block.used;
            block.used += (bytes + 15) / 16 * 16;
            block.used = std::min(block.used, block.buffer.bytes());
            return {&block, offset};
        }
    blocks.push_back(
        {Buffer(device_, std::max(k_staging_block, (bytes + 15) / 16 * 16), memory), (bytes + 15) / 16 * 16});
    return {&blocks.back(), 0};
}

void Stream::upload_bytes(Buffer& target, std::span<const std::byte> data, std::size_t offset) {
    check_bytes(target, offset, data.size());
    if (data.empty()) return;
    if (target.resource()->mapped && target.resource()->streams == 0) {
        std::memcpy(target.resource()->mapped + offset, data.data(), data.size());
        return;
    }
    begin();
    const auto [block, begin_byte] = stage(uploads_, data.size(), BufferMemory::upload);
    std::memcpy(block->buffer.resource()->mapped + begin_byte, data.data(), data.size());
    copy(block->buffer, begin_byte, target, offset, data.size());
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
    begin();
    use(source);
    use(target);
    order(std::array{copy_read(source), copy_write(target)});
    const VkBufferCopy region{source_offset, target_offset, bytes};
    vkCmdCopyBuffer(commands_, source.handle(), target.handle(), 1, &region);
}

void Stream::fill(const Buffer& target, std::uint32_t word) {
    check_bytes(target, 0, target.bytes());
    begin();
    use(target);
    order(std::array{copy_write(target)});
    vkCmdFillBuffer(commands_, target.handle(), 0, VK_WHOLE_SIZE, word);
}

void Stream::submit() {
    begin();
    // Later streams and the host see everything, whatever it was: one barrier at the end makes streams independent.
    const VkMemoryBarrier2 all{
        .sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
        .pNext = nullptr,
        .srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
        .srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT,
        .dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT | VK_PIPELINE_STAGE_2_HOST_BIT,
        .dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT | VK_ACCESS_2_HOST_READ_BIT};
    auto dependency = empty_structure<VkDependencyInfo>(VK_STRUCTURE_TYPE_DEPENDENCY_INFO);
    dependency.memoryBarrierCount = 1;
    dependency.pMemoryBarriers = &all;
    vkCmdPipelineBarrier2(commands_, &dependency);
    check(vkEndCommandBuffer(commands_), "record commands");
    device_.submit(commands_, fence_);
    submitted_ = true;
}

void Stream::wait() {
    if (!submitted_) return;
    check(vkWaitForFences(device_.handle(), 1, &fence_, VK_TRUE, UINT64_MAX), "wait for the device's work");
    check(vkResetFences(device_.handle(), 1, &fence_), "reset a fence");
    for (const Download& download : downloads_)
        std::memcpy(download.target.data(), download.source, download.target.size());
    collect_timings();
    release();
    check(vkResetCommandPool(device_.handle(), pool_, 0), "reset a command pool");
    for (VkDescriptorPool pool : descriptor_pools_)
        check(vkResetDescriptorPool(device_.handle(), pool, 0), "reset a descriptor pool");
    current_pool_ = 0;
    submitted_ = recording_ = false;
}

void Stream::finish() {
    submit();
    wait();
}

// Lets go of everything the finished work used.
void Stream::release() {
    for (const std::shared_ptr<Buffer::Resource>& buffer : buffers_) --buffer->streams;
    buffers_.clear();
    programs_.clear();
    downloads_.clear();
    timings_.clear();
    hazards_.reset();
    for (Staging& block : uploads_) block.used = 0;
    for (Staging& block : readbacks_) block.used = 0;
}

void Stream::start_timing(const Kernel& kernel) {
    timing_open_ = profiler_ && device_.info().timestamp_period > 0.0f && timings_.size() < k_timed_dispatches;
    if (!timing_open_) return;
    if (!queries_) {
        const VkQueryPoolCreateInfo info{.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO,
                                         .pNext = nullptr,
                                         .flags = 0,
                                         .queryType = VK_QUERY_TYPE_TIMESTAMP,
                                         .queryCount = 2 * k_timed_dispatches,
                                         .pipelineStatistics = 0};
        check(vkCreateQueryPool(device_.handle(), &info, nullptr, &queries_), "make timestamp queries");
    }
    if (timings_.empty()) vkCmdResetQueryPool(commands_, queries_, 0, 2 * k_timed_dispatches);
    const auto query = static_cast<std::uint32_t>(2 * timings_.size());
    timings_.push_back({kernel.program(), query});
    vkCmdWriteTimestamp2(commands_, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, queries_, query);
}

void Stream::stop_timing() {
    if (timing_open_)
        vkCmdWriteTimestamp2(commands_, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, queries_,
                             timings_.back().first_query + 1);
}

void Stream::collect_timings() {
    if (timings_.empty()) return;
    std::vector<std::uint64_t> ticks(2 * timings_.size());
    check(vkGetQueryPoolResults(device_.handle(), queries_, 0, static_cast<std::uint32_t>(ticks.size()),
                                ticks.size() * sizeof(std::uint64_t), ticks.data(), sizeof(std::uint64_t),
                                VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
          "read timestamps");
    for (const Timing& timing : timings_) {
        const std::uint64_t elapsed = ticks[timing.first_query + 1] - ticks[timing.first_query];
        profiler_->add(timing.program->name, static_cast<double>(elapsed) * device_.info().timestamp_period * 1e-6);
    }
}

}  // namespace exemplar
