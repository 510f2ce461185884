// Transfers of a stream: uploads and downloads through staging memory, copies, fills, and copies of images.

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "gpu/runtime/device/device.h"
#include "gpu/runtime/record/stream.h"
#include "gpu/runtime/vulkan/errors.h"
#include "gpu/runtime/vulkan/functions.h"

namespace exemplar {
namespace {

constexpr std::size_t k_staging_alignment = 16;

bool overlap(const VkBufferCopy& a, const VkBufferCopy& b) {
    return a.dstOffset < b.dstOffset + b.size && b.dstOffset < a.dstOffset + a.size;
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

void copy_texels(VkCommandBuffer commands, VkImage image, VkImageAspectFlags aspect, VkExtent2D extent, VkBuffer target,
                 VkDeviceSize offset) {
    VkBufferImageCopy region{};
    region.bufferOffset = offset;
    region.imageSubresource = {aspect, 0, 0, 1};
    region.imageExtent = {extent.width, extent.height, 1};
    vkCmdCopyImageToBuffer(commands, image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, target, 1, &region);
}

}  // namespace

void Stream::check_bytes(const Buffer& buffer, std::size_t offset, std::size_t bytes) {
    if (!buffer) throw DeviceError("a copy needs a buffer that has memory");
    buffer.check_range(offset, bytes);
}

void Stream::copy_image(VkImage image, VkImageAspectFlags aspect, VkExtent2D extent, std::size_t texel_bytes,
                        const Buffer& target) {
    check_bytes(target, 0, std::size_t{extent.width} * extent.height * texel_bytes);
    begin();
    use(target);
    order(std::array{copy_write(target)});
    copy_texels(commands(), image, aspect, extent, target.handle(), 0);
}

void Stream::download_image(VkImage image, VkImageAspectFlags aspect, VkExtent2D extent, std::span<std::byte> target) {
    if (target.empty()) return;
    device_.host_work().add(HostTask::byte_down, target.size());
    begin();
    const auto [block, first] = stage(readbacks_, target.size(), StagingUse::readback);
    copy_texels(commands(), image, aspect, extent, block->buffer.get(), first);
    downloads_.push_back({block->mapped() + first, target});
}

void Stream::blit(VkImage source, VkExtent2D extent, VkImage target, VkRect2D part) {
    begin();
    const auto corner = [](std::int64_t x, std::int64_t y, std::int32_t z) {
        return VkOffset3D{static_cast<std::int32_t>(x), static_cast<std::int32_t>(y), z};
    };
    VkImageBlit region{};
    region.srcSubresource = region.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    region.srcOffsets[1] = corner(extent.width, extent.height, 1);
    region.dstOffsets[0] = corner(part.offset.x, part.offset.y, 0);
    region.dstOffsets[1] =
        corner(std::int64_t{part.offset.x} + part.extent.width, std::int64_t{part.offset.y} + part.extent.height, 1);
    const bool scales = extent.width != part.extent.width || extent.height != part.extent.height;
    vkCmdBlitImage(commands(), source, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, target,
                   VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region, scales ? VK_FILTER_LINEAR : VK_FILTER_NEAREST);
}

// Each block is as large as all before it together, so that a recording needs few.
std::pair<StagingBlock*, std::size_t> Stream::stage(StagingBlocks& blocks, std::size_t bytes, StagingUse use) {
    const std::size_t padded = (bytes + k_staging_alignment - 1) / k_staging_alignment * k_staging_alignment;
    if (blocks.empty() || blocks.back()->left() < padded) {
        std::size_t sum = 0;
        for (const auto& block : blocks) sum += block->bytes;
        blocks.push_back(device_.staging().lend(std::max(sum, padded), use));
    }
    StagingBlock* const block = blocks.back().get();
    const std::size_t offset = block->used;
    block->used += padded;
    return {block, offset};
}

Stream::UploadTarget Stream::begin_upload(const Buffer& target, std::size_t offset, std::size_t bytes) {
    check_bytes(target, offset, bytes);
    if (bytes == 0) return {{}, nullptr, 0};
    device_.host_work().add(HostTask::byte_up, bytes);
    // No stream uses the target, so the host may write into it directly.
    if (target.resource()->mapped && target.resource()->streams == 0)
        return {{target.resource()->mapped + offset, bytes}, nullptr, 0};
    start();
    const auto [block, first] = stage(uploads_, bytes, StagingUse::upload);
    return {{block->mapped() + first, bytes}, block, first};
}

void Stream::end_upload(const UploadTarget& place, Buffer& target, std::size_t offset) {
    if (!place.staging) return;
    use(target);
    add_copy(place.staging->buffer.get(), target.handle(), {place.offset, offset, place.memory.size()},
             std::array{copy_write(target)});
}

void Stream::upload_bytes(Buffer& target, std::span<const std::byte> data, std::size_t offset) {
    upload_with(target, data.size(), offset,
                [&](std::span<std::byte> memory) { std::ranges::copy(data, memory.begin()); });
}

void Stream::download_bytes(const Buffer& source, std::span<std::byte> data, std::size_t offset) {
    check_bytes(source, offset, data.size());
    if (data.empty()) return;
    device_.host_work().add(HostTask::byte_down, data.size());
    start();
    const auto [block, begin_byte] = stage(readbacks_, data.size(), StagingUse::readback);
    use(source);
    add_copy(source.handle(), block->buffer.get(), {offset, begin_byte, data.size()}, std::array{copy_read(source)});
    downloads_.push_back({block->mapped() + begin_byte, data});
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
    use(source);
    use(target);
    add_copy(source.handle(), target.handle(), {source_offset, target_offset, bytes},
             std::array{copy_read(source), copy_write(target)});
}

// Returns whether the region can join the collected ones: regions of one command are copied in any order.
bool Stream::extends_copies(VkBuffer source, VkBuffer target, const VkBufferCopy& region) const {
    if (copies_.regions.empty() || copies_.source != source || copies_.target != target || source == target)
        return false;
    return region.dstOffset >= copies_.end ||
           std::ranges::none_of(copies_.regions, [&](const VkBufferCopy& other) { return overlap(region, other); });
}

// Staging memory needs no barriers: no two transfers of a recording share any. So `accesses` are those of buffers.
void Stream::add_copy(VkBuffer source, VkBuffer target, const VkBufferCopy& region, std::span<const Access> accesses) {
    if (extends_copies(source, target, region)) {
        VkBufferCopy& last = copies_.regions.back();
        if (last.srcOffset + last.size == region.srcOffset && last.dstOffset + last.size == region.dstOffset)
            last.size += region.size;
        else
            copies_.regions.push_back(region);
    } else {
        begin();
        order(accesses);
        copies_.source = source;
        copies_.target = target;
        copies_.end = 0;
        copies_.regions.assign(1, region);
    }
    copies_.end = std::max(copies_.end, region.dstOffset + region.size);
}

void Stream::record_copies() {
    if (copies_.regions.empty()) return;
    vkCmdCopyBuffer(commands(), copies_.source, copies_.target, static_cast<std::uint32_t>(copies_.regions.size()),
                    copies_.regions.data());
    device_.host_work().add(HostTask::copy);
    device_.host_work().add(HostTask::copied_region, copies_.regions.size());
    copies_.regions.clear();
}

void Stream::fill(const Buffer& target, std::uint32_t word) {
    check_bytes(target, 0, target.bytes());
    begin();
    use(target);
    order(std::array{copy_write(target)});
    vkCmdFillBuffer(commands(), target.handle(), 0, VK_WHOLE_SIZE, word);
}

void Stream::fetch(const Buffer& source, std::span<const HostReadback> parts) {
    std::vector<BufferReadback> of_source;
    of_source.reserve(parts.size());
    for (const HostReadback& part : parts) of_source.push_back({&source, part.offset, part.target});
    fetch(of_source);
}

void Stream::fetch(std::span<const BufferReadback> parts) {
    const auto mapped = [](const BufferReadback& part) { return *part.source && part.source->resource()->mapped; };
    // One block for all, so that the parts of a buffer are one copy.
    std::size_t staged = 0;
    for (const BufferReadback& part : parts)
        if (!mapped(part)) staged += part.target.size() + k_staging_alignment;
    if (staged > 0) readbacks_.push_back(device_.staging().lend(staged, StagingUse::readback));
    for (const BufferReadback& part : parts)
        if (!mapped(part)) download_bytes(*part.source, part.target, part.offset);
    finish();
    for (const BufferReadback& part : parts)
        if (mapped(part)) part.source->read(part.target, part.offset);
}

}  // namespace exemplar
