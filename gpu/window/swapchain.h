#pragma once

#include <volk.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "gpu/runtime/device/commands.h"
#include "gpu/runtime/device/unique_handle.h"

namespace exemplar {

class Device;

/// An image of a window while it is drawn, in VK_IMAGE_LAYOUT_UNDEFINED. Its contents are undefined.
struct WindowImage {
    VkImage image = VK_NULL_HANDLE;
    VkImageView view = VK_NULL_HANDLE;
    VkExtent2D extent{};
    /// What the submission that draws it waits for and tells; stages before copies and color output may run ahead.
    SubmitOrder order;
    std::uint32_t index = 0;
};

/// The images that a window shows one after the other, of 8-bit colors that are taken as they are. They follow the
/// window's size. One thread at a time may use it.
class Swapchain {
  public:
    /// Takes over a surface of device.instance(). Throws DeviceError if it has no fitting format.
    Swapchain(Device& device, VkSurfaceKHR surface);
    /// Waits for the device.
    ~Swapchain();
    Swapchain(const Swapchain&) = delete;
    Swapchain& operator=(const Swapchain&) = delete;

    VkFormat format() const { return format_.format; }
    /// The next image to draw; nothing while the window has no pixels. `window` is its size as the window system tells
    /// it. The submission that drew the last image must have been waited for. Throws SurfaceLostError or
    /// DeviceLostError.
    std::optional<WindowImage> acquire(VkExtent2D window);
    /// Shows the image when the submission with its order is done; it must be in VK_IMAGE_LAYOUT_PRESENT_SRC_KHR.
    /// Throws as acquire.
    void present(const WindowImage& image);
    /// Gives an image up that was acquired and then not drawn.
    void abandon();

  private:
    // A new semaphore would do for every image, but semaphores may only end when nothing waits for them any more.
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
    std::vector<UniqueSemaphore> acquired_;  // one more than slots
    std::size_t next_acquired_ = 0;
    bool stale_ = true;
};

}  // namespace exemplar
