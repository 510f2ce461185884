#pragma once

#include <vulkan/vulkan_core.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "gpu/runtime/device/commands.h"
#include "gpu/runtime/vulkan/unique_handle.h"

namespace exemplar {

class Device;

/// An image of a window to draw into, in VK_IMAGE_LAYOUT_UNDEFINED. Its contents are undefined.
struct WindowImage {
    VkImage image = VK_NULL_HANDLE;
    VkImageView view = VK_NULL_HANDLE;
    VkExtent2D extent{};
    /// Semaphores that the submission drawing the image waits for and signals; stages before copies and color output
    /// may start earlier.
    SubmitOrder order;
    std::uint32_t index = 0;
};

/// The images that a window shows one after the other, with 8-bit colors that are shown unconverted. Follows the
/// window's size. One thread at a time may use it.
class Swapchain {
  public:
    /// Takes ownership of a surface of device.instance(). Throws DeviceError if the surface has no suitable format.
    Swapchain(Device& device, VkSurfaceKHR surface);
    /// Waits for the device.
    ~Swapchain();
    Swapchain(const Swapchain&) = delete;
    Swapchain& operator=(const Swapchain&) = delete;

    VkFormat format() const { return format_.format; }
    /// Returns the next image to draw; nothing while the window has no pixels. `window` is its size as reported by
    /// the window system. The submission that drew the previous image must have been waited for. Throws
    /// SurfaceLostError or DeviceLostError.
    std::optional<WindowImage> acquire(VkExtent2D window);
    /// Shows the image once the submission with its order is done. It must be in VK_IMAGE_LAYOUT_PRESENT_SRC_KHR.
    /// Throws as acquire does.
    void present(const WindowImage& image);

  private:
    // Semaphores are kept, since one may only be destroyed when nothing waits for it any more.
    struct Slot {
        VkImage image;
        UniqueImageView view;
        UniqueSemaphore drawn;
    };
    void choose_format();
    bool create(VkExtent2D window);
    void create_slots();
    void release();
    Device& device_;
    VkSurfaceKHR surface_;
    VkSurfaceFormatKHR format_{};
    VkExtent2D extent_{};
    UniqueSwapchain swapchain_;
    std::vector<Slot> slots_;
    std::vector<UniqueSemaphore> acquired_;  // one more than there are slots
    std::size_t next_acquired_ = 0;
    bool stale_ = true;
};

}  // namespace exemplar
