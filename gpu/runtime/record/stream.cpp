#include "gpu/runtime/record/stream.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstring>

#include "gpu/runtime/device/device.h"
#include "gpu/runtime/vulkan/errors.h"
#include "gpu/runtime/vulkan/functions.h"

namespace exemplar {
namespace {

// Sets the ticket to a later one; other threads may do so at the same time.
void raise(std::atomic<Ticket>& ticket, Ticket later) {
    for (Ticket now = ticket; now < later && !ticket.compare_exchange_weak(now, later);) {
    }
}

Access access_of(const ReflectedBinding& binding, const BufferRange& range, VkPipelineStageFlags2 stage) {
    return {.buffer = range.buffer->handle(),
            .stage = stage,
            .reads = binding.type == BindingType::texels ? VK_ACCESS_2_SHADER_SAMPLED_READ_BIT
                     : binding.reads                     ? VK_ACCESS_2_SHADER_STORAGE_READ_BIT
                                                         : VK_ACCESS_2_NONE,
            .writes = binding.writes ? VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT : VK_ACCESS_2_NONE};
}

Access indirect_read(const Buffer& buffer) {
    return {.buffer = buffer.handle(),
            .stage = VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT,
            .reads = VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT};
}

Access index_read(const Buffer& buffer) {
    return {
        .buffer = buffer.handle(), .stage = VK_PIPELINE_STAGE_2_INDEX_INPUT_BIT, .reads = VK_ACCESS_2_INDEX_READ_BIT};
}

void check_push(const Program& program, std::span<const std::byte> push) {
    if (push.size() != program.reflection.push_bytes)
        throw ShaderError(fmt::format("{} takes {} bytes of push constants, not {}", program.name,
                                      program.reflection.push_bytes, push.size()));
}

void begin_rendering(VkCommandBuffer commands, const PassTarget& target) {
    const auto attachment = [](VkImageView view, VkImageLayout layout, bool clears) {
        auto info = empty_structure<VkRenderingAttachmentInfo>(VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO);
        info.imageView = view;
        info.imageLayout = layout;
        info.loadOp = clears ? VK_ATTACHMENT_LOAD_OP_CLEAR : VK_ATTACHMENT_LOAD_OP_LOAD;
        info.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
        return info;
    };
    auto color = attachment(target.color, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, target.clear_color.has_value());
    if (target.clear_color) std::ranges::copy(*target.clear_color, color.clearValue.color.float32);
    auto depth = attachment(target.depth, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL, target.clear_depth.has_value());
    if (target.clear_depth) depth.clearValue.depthStencil = {*target.clear_depth, 0};
    auto rendering = empty_structure<VkRenderingInfo>(VK_STRUCTURE_TYPE_RENDERING_INFO);
    rendering.renderArea = {{0, 0}, target.extent};
    rendering.layerCount = 1;
    rendering.colorAttachmentCount = target.color ? 1 : 0;
    rendering.pColorAttachments = &color;
    rendering.pDepthAttachment = target.depth ? &depth : nullptr;
    vkCmdBeginRendering(commands, &rendering);
    const VkViewport viewport{0, 0, static_cast<float>(target.extent.width), static_cast<float>(target.extent.height),
                              0, 1};
    vkCmdSetViewport(commands, 0, 1, &viewport);
}

void record_draw(VkCommandBuffer commands, const Draw& draw, VkExtent2D extent) {
    const VkRect2D scissor = draw.scissor.value_or(VkRect2D{{0, 0}, extent});
    vkCmdSetScissor(commands, 0, 1, &scissor);
    if (draw.indirect)
        vkCmdDrawIndirect(commands, draw.indirect->handle(), draw.indirect_offset, 1, sizeof(VkDrawIndirectCommand));
    else if (draw.vertices > 0 && draw.indices) {
        vkCmdBindIndexBuffer(commands, draw.indices->handle(), 0, VK_INDEX_TYPE_UINT32);
        vkCmdDrawIndexed(commands, draw.vertices, 1, draw.first_vertex, 0, 0);
    } else if (draw.vertices > 0)
        vkCmdDraw(commands, draw.vertices, 1, draw.first_vertex, 0);
}

}  // namespace

Stream::Stream(Device& device, Profiler* profiler)
    : device_(device), descriptors_(device), timestamps_(device, profiler), commands_(device) {}

Stream::~Stream() {
    try {
        commands_.wait();
    } catch (const DeviceError&) {
        // A lost device runs nothing to wait for.
    }
    release();
}

// Starts a recording unless it has started.
void Stream::start() {
    if (external_state_ == External::recording) return;
    if (external_state_ == External::recorded)
        throw DeviceError("a stream was used before the caller's commands were done; call retire() first");
    if (commands_.state() == Commands::State::idle) barriers_.clear();
    commands_.begin();
}

void Stream::record_into(VkCommandBuffer commands) {
    if (external_ || commands_.state() != Commands::State::idle)
        throw DeviceError("a stream that has recorded work cannot record into other commands; finish it first");
    barriers_.clear();
    external_ = commands;
    external_state_ = External::recording;
    record_full_barrier(external_);
}

void Stream::end_recording() {
    if (external_state_ != External::recording)
        throw DeviceError("a stream that records into no command buffer of the caller's cannot end that");
    record_copies();
    record_full_barrier(external_);
    external_state_ = External::recorded;
}

void Stream::retire() {
    if (!external_) return;
    external_ = VK_NULL_HANDLE;
    external_state_ = External::none;
    deliver();
}

// Begins the next command: copies that were collected come before it.
void Stream::begin() {
    start();
    record_copies();
}

void Stream::use(const Buffer& buffer) {
    if (buffers_.insert(buffer.resource()).second) ++buffer.resource()->streams;
}

void Stream::order(std::span<const Access> accesses) {
    const std::vector<Barrier> barriers = hazards_.before(accesses);
    if (barriers.empty()) return;
    // One barrier for all memory: drivers treat those of single buffers alike.
    auto all = empty_structure<VkMemoryBarrier2>(VK_STRUCTURE_TYPE_MEMORY_BARRIER_2);
    for (const Barrier& barrier : barriers) {
        all.srcStageMask |= barrier.source_stage;
        all.srcAccessMask |= barrier.source_access;
        all.dstStageMask |= barrier.target_stage;
        all.dstAccessMask |= barrier.target_access;
    }
    auto dependency = empty_structure<VkDependencyInfo>(VK_STRUCTURE_TYPE_DEPENDENCY_INFO);
    dependency.memoryBarrierCount = 1;
    dependency.pMemoryBarriers = &all;
    vkCmdPipelineBarrier2(commands(), &dependency);
    device_.host_work().add(HostTask::barrier);
    barriers_.insert(barriers_.end(), barriers.begin(), barriers.end());
}

// Records all of a dispatch but the dispatch command. `accesses` are those in addition to its bindings.
void Stream::prepare(const Kernel& kernel, std::span<const BufferRange> ranges, std::span<const std::byte> push,
                     std::vector<Access> accesses) {
    const Program& program = *kernel.program();
    for (std::size_t i = 0; i < ranges.size(); ++i) {
        accesses.push_back(
            access_of(program.reflection.bindings[i], ranges[i], VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT));
        use(*ranges[i].buffer);
    }
    programs_.insert(kernel.program());
    order(accesses);
    vkCmdBindPipeline(commands(), VK_PIPELINE_BIND_POINT_COMPUTE, program.pipeline.get());
    descriptors_.bind(commands(), program, ranges);
    if (!push.empty())
        vkCmdPushConstants(commands(), program.layout.get(), program.stages, 0, static_cast<std::uint32_t>(push.size()),
                           push.data());
    timestamps_.start(commands(), program.name);
}

void Stream::dispatch_bytes(const Kernel& kernel, Threads threads, std::span<const BufferRange> ranges,
                            std::span<const std::byte> push) {
    check_push(*kernel.program(), push);
    descriptors_.check_bindings(*kernel.program(), ranges);
    if (threads.x == 0 || threads.y == 0 || threads.z == 0) return;
    const std::array<std::uint32_t, 3> groups = workgroups(kernel, threads, device_.info());
    begin();
    prepare(kernel, ranges, push, {});
    vkCmdDispatch(commands(), groups[0], groups[1], groups[2]);
    device_.host_work().add(HostTask::dispatch);
    timestamps_.stop(commands(), VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT);
}

void Stream::dispatch_indirect_bytes(const Kernel& kernel, const Buffer& arguments, std::size_t offset,
                                     std::span<const BufferRange> ranges, std::span<const std::byte> push) {
    check_push(*kernel.program(), push);
    descriptors_.check_bindings(*kernel.program(), ranges);
    check_bytes(arguments, offset, sizeof(VkDispatchIndirectCommand));
    begin();
    use(arguments);
    prepare(kernel, ranges, push, {indirect_read(arguments)});
    vkCmdDispatchIndirect(commands(), arguments.handle(), offset);
    device_.host_work().add(HostTask::dispatch);
    timestamps_.stop(commands(), VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT);
}

void Stream::render(const Pass& pass) {
    constexpr VkPipelineStageFlags2 k_shaders =
        VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT | VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT;
    std::vector<Access> accesses;
    begin();
    for (const Pass::Item& item : pass.items()) {
        check_push(*item.program, item.push);
        descriptors_.check_bindings(*item.program, item.bindings);
        for (std::size_t i = 0; i < item.bindings.size(); ++i) {
            accesses.push_back(access_of(item.program->reflection.bindings[i], item.bindings[i], k_shaders));
            use(*item.bindings[i].buffer);
        }
        programs_.insert(item.program);
        if (item.draw.indices) {
            check_bytes(*item.draw.indices, std::size_t{4} * item.draw.first_vertex,
                        std::size_t{4} * item.draw.vertices);
            accesses.push_back(index_read(*item.draw.indices));
            use(*item.draw.indices);
        }
        if (item.draw.indirect) {
            check_bytes(*item.draw.indirect, item.draw.indirect_offset, sizeof(VkDrawIndirectCommand));
            accesses.push_back(indirect_read(*item.draw.indirect));
            use(*item.draw.indirect);
        }
    }
    // Within a pass there can be no barriers.
    order(accesses);
    timestamps_.start(commands(), pass.name());
    begin_rendering(commands(), pass.target());
    for (const Pass::Item& item : pass.items()) {
        const Program& program = *item.program;
        vkCmdBindPipeline(commands(), VK_PIPELINE_BIND_POINT_GRAPHICS, program.pipeline.get());
        descriptors_.bind(commands(), program, item.bindings);
        if (!item.push.empty())
            vkCmdPushConstants(commands(), program.layout.get(), program.stages, 0,
                               static_cast<std::uint32_t>(item.push.size()), item.push.data());
        record_draw(commands(), item.draw, pass.target().extent);
    }
    vkCmdEndRendering(commands());
    device_.host_work().add(HostTask::pass);
    timestamps_.stop(commands(), VK_PIPELINE_STAGE_2_ALL_GRAPHICS_BIT);
}

void Stream::transition(VkImage image, VkImageAspectFlags aspect, VkImageLayout from, VkImageLayout to,
                        const Transition& transition) {
    begin();
    change_layout(commands(), image, aspect, from, to, transition);
}

Ticket Stream::submit(const SubmitOrder& order) {
    if (external_) throw DeviceError("the caller submits its own commands; call end_recording() and retire()");
    begin();
    try {
        const Ticket ticket = commands_.submit(order);
        for (const std::shared_ptr<Buffer::Resource>& buffer : buffers_) raise(buffer->last_use, ticket);
        return ticket;
    } catch (const DeviceError&) {
        release();
        throw;
    }
}

void Stream::discard() {
    if (external_ || commands_.state() == Commands::State::submitted) return;
    commands_.discard();
    release();
}

void Stream::wait() {
    if (commands_.state() != Commands::State::submitted) return;
    commands_.wait();
    deliver();
}

// Copies downloads of finished work to where they go, and releases what it used.
void Stream::deliver() {
    for (const Download& download : downloads_)
        std::memcpy(download.target.data(), download.source, download.target.size());
    timestamps_.collect();
    release();
}

void Stream::finish() {
    submit();
    wait();
}

// Releases everything that the finished work used.
void Stream::release() {
    for (const std::shared_ptr<Buffer::Resource>& buffer : buffers_) --buffer->streams;
    buffers_.clear();
    programs_.clear();
    downloads_.clear();
    timestamps_.clear();
    descriptors_.reset();
    hazards_.reset();
    copies_.regions.clear();
    for (StagingBlocks* blocks : {&uploads_, &readbacks_}) {
        for (std::unique_ptr<StagingBlock>& block : *blocks) device_.staging().give_back(std::move(block));
        blocks->clear();
    }
}

}  // namespace exemplar
