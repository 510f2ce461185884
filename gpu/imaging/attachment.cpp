#include "gpu/imaging/attachment.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

#include "gpu/runtime/device/device.h"
#include "gpu/runtime/vulkan/errors.h"
#include "gpu/runtime/vulkan/functions.h"

namespace exemplar {
namespace {

void check_extent(const Device& device, VkExtent2D extent) {
    VkPhysicalDeviceProperties properties{};
    vkGetPhysicalDeviceProperties(device.physical(), &properties);
    const std::uint32_t limit = properties.limits.maxImageDimension2D, largest = std::max(extent.width, extent.height);
    if (largest > limit)
        throw DeviceLimitError(
            fmt::format("an image of {} x {} is over the limit of {} of device '{}'; draw smaller tiles", extent.width,
                        extent.height, limit, device.info().name),
            largest, limit);
}

}  // namespace

Attachment::Attachment(Device& device, VkFormat format, VkExtent2D extent, VkImageUsageFlags usage,
                       VkImageAspectFlags aspect)
    : image_(device.handle()), view_(device.handle()) {
    check_extent(device, extent);
    const auto what = [&] {
        return fmt::format("make an image of {} x {} on '{}'", extent.width, extent.height, device.info().name);
    };
    auto image = empty_structure<VkImageCreateInfo>(VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO);
    image.imageType = VK_IMAGE_TYPE_2D;
    image.format = format;
    image.extent = {extent.width, extent.height, 1};
    image.mipLevels = image.arrayLayers = 1;
    image.samples = VK_SAMPLE_COUNT_1_BIT;
    image.tiling = VK_IMAGE_TILING_OPTIMAL;
    image.usage = usage;
    check(vkCreateImage(device.handle(), &image, nullptr, image_.put()), what);

    VkMemoryRequirements needs{};
    vkGetImageMemoryRequirements(device.handle(), image_.get(), &needs);
    const std::uint32_t type = device.memory_type(needs.memoryTypeBits, 0, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
    check(device.memory().allocate(needs, type, MemoryContent::image, memory_), what);
    check(vkBindImageMemory(device.handle(), image_.get(), memory_.memory(), memory_.offset()), what);

    auto view = empty_structure<VkImageViewCreateInfo>(VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO);
    view.image = image_.get();
    view.viewType = VK_IMAGE_VIEW_TYPE_2D;
    view.format = format;
    view.subresourceRange = {aspect, 0, 1, 0, 1};
    check(vkCreateImageView(device.handle(), &view, nullptr, view_.put()), what);
}

VkFormat depth_format(const Device& device) {
    VkFormatProperties properties{};
    vkGetPhysicalDeviceFormatProperties(device.physical(), VK_FORMAT_D32_SFLOAT, &properties);
    return properties.optimalTilingFeatures & VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT
               ? VK_FORMAT_D32_SFLOAT
               : VK_FORMAT_X8_D24_UNORM_PACK32;
}

}  // namespace exemplar
