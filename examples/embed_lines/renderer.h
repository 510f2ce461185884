// A small renderer in plain Vulkan, which knows nothing of Exemplar: it stands for yours.
#pragma once

#include <vulkan/vulkan.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#ifdef HAS_WINDOW
#include <GLFW/glfw3.h>
#else
struct GLFWwindow;
#endif

constexpr std::uint32_t k_frames_in_flight = 2;
constexpr VkFormat k_color_format = VK_FORMAT_R8G8B8A8_UNORM, k_depth_format = VK_FORMAT_D32_SFLOAT;

struct Vertex {
    std::array<float, 3> position, normal;
};

struct Image {
    VkImage image;
    VkDeviceMemory memory;
    VkImageView view;
};

struct HostBuffer {
    VkBuffer buffer;
    VkDeviceMemory memory;
    std::byte* mapped;
};

/// The resources of one frame in flight.
struct Frame {
    VkCommandBuffer commands;
    Image color, depth;
    HostBuffer vertices, pixels;
    VkSemaphore acquired;
    std::uint64_t finished = 0;  ///< value of the timeline when the device is done
};

class Renderer {
  public:
    /// `window`: null for none. `validate`: with the validation layer; its messages go to standard error.
    Renderer(GLFWwindow* window, VkExtent2D size, bool validate, std::span<const std::uint32_t> indices,
             std::size_t vertices);
    ~Renderer();

    /// Waits until the frame's last use is over, and begins its commands.
    Frame& begin(std::uint64_t number);
    /// Records the figure, shaded from 0 (white) to 1, into frame.color, which stays a color attachment.
    void draw_figure(Frame& frame, std::span<const Vertex> vertices, const float* clip_from_mesh, float shade) const;
    /// Copies the picture to frame.pixels, or shows it in the window, and submits.
    void end(Frame& frame);
    void wait(const Frame& frame) const;
    std::size_t messages() const { return messages_; }  ///< of the validation layer

    VkInstance instance{};
    VkPhysicalDevice physical{};
    VkDevice device{};
    VkQueue queue{};
    std::uint32_t family = 0;
    VkPhysicalDeviceVulkan12Features features12{};
    VkPhysicalDeviceVulkan13Features features13{};

  private:
    VkExtent2D size_;
    void make_instance(bool windowed, bool validate);
    void make_device(bool windowed);
    void make_swapchain();
    void make_pipeline();
    void make_frames(std::size_t vertices);
    Image make_image(VkFormat format, VkImageUsageFlags usage, VkImageAspectFlags aspect) const;
    HostBuffer make_buffer(VkDeviceSize bytes, VkBufferUsageFlags usage) const;
    std::uint32_t memory_type(std::uint32_t allowed, VkMemoryPropertyFlags wanted) const;
    void show(Frame& frame);
    void submit(Frame& frame, VkSemaphore wait, VkSemaphore signal);
    VkSurfaceKHR surface_{};
    VkSwapchainKHR swapchain_{};
    std::vector<VkImage> images_;
    std::vector<VkSemaphore> drawn_;  // by image
    VkCommandPool pool_{};
    VkSemaphore timeline_{};
    std::uint64_t submitted_ = 0;
    VkPipelineLayout layout_{};
    VkPipeline pipeline_{};
    HostBuffer indices_{};
    std::uint32_t index_count_ = 0;
    std::array<Frame, k_frames_in_flight> frames_{};
    std::size_t messages_ = 0;
};
