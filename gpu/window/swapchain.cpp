#include "gpu/window/swapchain.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "gpu/runtime/device/device.h"
#include "gpu/runtime/vulkan/errors.h"
#include "gpu/runtime/vulkan/functions.h"

namespace exemplar {
namespace {

UniqueSemaphore make_semaphore(const Device& device) {
    UniqueSemaphore semaphore(device.handle());
    const auto info = empty_structure<VkSemaphoreCreateInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO);
    check(vkCreateSemaphore(device.handle(), &info, nullptr, semaphore.put()), "make a semaphore");
    return semaphore;
}

UniqueImageView make_view(const Device& device, VkImage image, VkFormat format) {
    UniqueImageView view(device.handle());
    auto info = empty_structure<VkImageViewCreateInfo>(VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO);
    info.image = image;
    info.viewType = VK_IMAGE_VIEW_TYPE_2D;
    info.format = format;
    info.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    check(vkCreateImageView(device.handle(), &info, nullptr, view.put()), "see an image of the window");
    return view;
}

VkSurfaceCapabilitiesKHR capabilities_of(const Device& device, VkSurfaceKHR surface) {
    VkSurfaceCapabilitiesKHR capabilities{};
    check(vkGetPhysicalDeviceSurfaceCapabilitiesKHR(device.physical(), surface, &capabilities),
          "ask for the window's size");
    return capabilities;
}

// Returns the image size: some surfaces have one, others take that of their images.
VkExtent2D fitting_extent(const VkSurfaceCapabilitiesKHR& capabilities, VkExtent2D window) {
    if (capabilities.currentExtent.width != UINT32_MAX) return capabilities.currentExtent;
    const VkExtent2D low = capabilities.minImageExtent, high = capabilities.maxImageExtent;
    return {std::clamp(window.width, low.width, high.width), std::clamp(window.height, low.height, high.height)};
}

VkCompositeAlphaFlagBitsKHR opaque_alpha(const VkSurfaceCapabilitiesKHR& capabilities) {
    for (const VkCompositeAlphaFlagBitsKHR alpha :
         {VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR, VK_COMPOSITE_ALPHA_INHERIT_BIT_KHR})
        if (capabilities.supportedCompositeAlpha & alpha) return alpha;
    return VK_COMPOSITE_ALPHA_PRE_MULTIPLIED_BIT_KHR;
}

std::uint32_t image_count(const VkSurfaceCapabilitiesKHR& capabilities) {
    const std::uint32_t wanted = capabilities.minImageCount + 1;
    return capabilities.maxImageCount > 0 ? std::min(wanted, capabilities.maxImageCount) : wanted;
}

}  // namespace

Swapchain::Swapchain(Device& device, VkSurfaceKHR surface) : device_(device), surface_(surface) {
    try {
        choose_format();
    } catch (...) {
        vkDestroySurfaceKHR(device.instance(), surface, nullptr);
        throw;
    }
}

Swapchain::~Swapchain() {
    release();
    swapchain_ = {};
    vkDestroySurfaceKHR(device_.instance(), surface_, nullptr);
}

// Chooses a UNORM format: pictures hold sRGB values already, which must not be encoded again.
void Swapchain::choose_format() {
    VkBool32 presents = VK_FALSE;
    check(vkGetPhysicalDeviceSurfaceSupportKHR(device_.physical(), device_.queue_family(), surface_, &presents),
          "ask whether the device can present to the window");
    if (!presents)
        throw DeviceError(fmt::format("device '{}' cannot show images in this window; choose another with --device",
                                      device_.info().name));
    std::uint32_t count = 0;
    check(vkGetPhysicalDeviceSurfaceFormatsKHR(device_.physical(), surface_, &count, nullptr),
          "list the window's formats");
    std::vector<VkSurfaceFormatKHR> formats(count);
    check(vkGetPhysicalDeviceSurfaceFormatsKHR(device_.physical(), surface_, &count, formats.data()),
          "list the window's formats");
    for (const VkFormat wanted : {VK_FORMAT_B8G8R8A8_UNORM, VK_FORMAT_R8G8B8A8_UNORM})
        for (const VkSurfaceFormatKHR& format : formats)
            if (format.format == wanted && format.colorSpace == VK_COLOR_SPACE_SRGB_NONLINEAR_KHR) {
                format_ = format;
                return;
            }
    throw DeviceError(fmt::format("the window has no 8-bit UNORM format on device '{}'; choose another with --device",
                                  device_.info().name));
}

void Swapchain::release() {
    try {
        device_.wait_idle();
    } catch (const DeviceError&) {
        // A lost device has no work in flight.
    }
    slots_.clear();
    acquired_.clear();
}

// Creates the swapchain; returns false if the window has no pixels.
bool Swapchain::create(VkExtent2D window) {
    if (window.width == 0 || window.height == 0) return false;
    release();
    const VkSurfaceCapabilitiesKHR capabilities = capabilities_of(device_, surface_);
    extent_ = fitting_extent(capabilities, window);
    if (extent_.width == 0 || extent_.height == 0) return false;
    auto info = empty_structure<VkSwapchainCreateInfoKHR>(VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR);
    info.surface = surface_;
    info.minImageCount = image_count(capabilities);
    info.imageFormat = format_.format;
    info.imageColorSpace = format_.colorSpace;
    info.imageExtent = extent_;
    info.imageArrayLayers = 1;
    info.imageUsage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    info.imageSharingMode = VK_SHARING_MODE_EXCLUSIVE;
    info.preTransform = capabilities.currentTransform;
    info.compositeAlpha = opaque_alpha(capabilities);
    info.presentMode = VK_PRESENT_MODE_FIFO_KHR;  // every device supports it, and every frame drawn is shown
    info.clipped = VK_TRUE;
    info.oldSwapchain = swapchain_.get();
    UniqueSwapchain next(device_.handle());
    check(vkCreateSwapchainKHR(device_.handle(), &info, nullptr, next.put()),
          [&] { return fmt::format("make images of {} x {} for the window", extent_.width, extent_.height); });
    swapchain_ = std::move(next);
    create_slots();
    stale_ = false;
    return true;
}

void Swapchain::create_slots() {
    std::uint32_t count = 0;
    check(vkGetSwapchainImagesKHR(device_.handle(), swapchain_.get(), &count, nullptr), "list the window's images");
    std::vector<VkImage> images(count);
    check(vkGetSwapchainImagesKHR(device_.handle(), swapchain_.get(), &count, images.data()),
          "list the window's images");
    for (const VkImage image : images)
        slots_.push_back({image, make_view(device_, image, format_.format), make_semaphore(device_)});
    for (std::size_t i = 0; i <= slots_.size(); ++i) acquired_.push_back(make_semaphore(device_));
    next_acquired_ = 0;
}

std::optional<WindowImage> Swapchain::acquire(VkExtent2D window) {
    // While the user resizes the window, its size may change again before the images exist; then the next frame
    // fits.
    constexpr int k_tries = 3;
    if (window.width != extent_.width || window.height != extent_.height) stale_ = true;
    for (int i = 0; i < k_tries; ++i) {
        if (stale_ && !create(window)) return std::nullopt;
        const VkSemaphore acquired = acquired_[next_acquired_].get();
        WindowImage next;
        const VkResult result = vkAcquireNextImageKHR(device_.handle(), swapchain_.get(), UINT64_MAX, acquired,
                                                      VK_NULL_HANDLE, &next.index);
        if (result == VK_ERROR_OUT_OF_DATE_KHR) {
            stale_ = true;
            continue;
        }
        if (result == VK_SUBOPTIMAL_KHR)
            stale_ = true;  // to be recreated when this image has been shown
        else
            check(result, "get an image of the window");
        next_acquired_ = (next_acquired_ + 1) % acquired_.size();
        const Slot& slot = slots_[next.index];
        next.image = slot.image;
        next.view = slot.view.get();
        next.extent = extent_;
        next.order = {
            .wait = acquired,
            .wait_stage = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT | VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
            .signal = slot.drawn.get()};
        return next;
    }
    return std::nullopt;
}

void Swapchain::present(const WindowImage& image) {
    auto info = empty_structure<VkPresentInfoKHR>(VK_STRUCTURE_TYPE_PRESENT_INFO_KHR);
    const VkSwapchainKHR swapchain = swapchain_.get();
    info.waitSemaphoreCount = 1;
    info.pWaitSemaphores = &image.order.signal;
    info.swapchainCount = 1;
    info.pSwapchains = &swapchain;
    info.pImageIndices = &image.index;
    const VkResult result = device_.present(info);
    if (result == VK_SUBOPTIMAL_KHR || result == VK_ERROR_OUT_OF_DATE_KHR)
        stale_ = true;
    else
        check(result, "show an image in the window");
}

}  // namespace exemplar
