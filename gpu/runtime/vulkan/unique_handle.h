#pragma once

#include <vulkan/vulkan_core.h>

#include <utility>

namespace exemplar {

// Destroys an object of a device.
void destroy(VkDevice device, VkBuffer handle);
void destroy(VkDevice device, VkBufferView handle);
void destroy(VkDevice device, VkImage handle);
void destroy(VkDevice device, VkImageView handle);
void destroy(VkDevice device, VkDeviceMemory handle);
void destroy(VkDevice device, VkShaderModule handle);
void destroy(VkDevice device, VkDescriptorSetLayout handle);
void destroy(VkDevice device, VkDescriptorPool handle);
void destroy(VkDevice device, VkPipelineLayout handle);
void destroy(VkDevice device, VkPipeline handle);
void destroy(VkDevice device, VkCommandPool handle);
void destroy(VkDevice device, VkSemaphore handle);
void destroy(VkDevice device, VkSwapchainKHR handle);
void destroy(VkDevice device, VkQueryPool handle);

/// Owns one Vulkan object of a device.
template <typename Handle>
class UniqueHandle {
  public:
    UniqueHandle() = default;
    explicit UniqueHandle(VkDevice device) : device_(device) {}
    UniqueHandle(UniqueHandle&& other) noexcept
        : device_(other.device_), handle_(std::exchange(other.handle_, Handle{VK_NULL_HANDLE})) {}
    UniqueHandle& operator=(UniqueHandle&& other) noexcept {
        std::swap(device_, other.device_);
        std::swap(handle_, other.handle_);
        return *this;
    }
    UniqueHandle(const UniqueHandle&) = delete;
    UniqueHandle& operator=(const UniqueHandle&) = delete;
    ~UniqueHandle() {
        if (handle_ != VK_NULL_HANDLE) destroy(device_, handle_);
    }

    Handle get() const { return handle_; }
    /// Returns the address that a vkCreate function writes to; only for a handle that owns no object yet.
    Handle* put() { return &handle_; }

  private:
    VkDevice device_ = VK_NULL_HANDLE;
    Handle handle_ = VK_NULL_HANDLE;
};

using UniqueBuffer = UniqueHandle<VkBuffer>;
using UniqueBufferView = UniqueHandle<VkBufferView>;
using UniqueImage = UniqueHandle<VkImage>;
using UniqueImageView = UniqueHandle<VkImageView>;
using UniqueMemory = UniqueHandle<VkDeviceMemory>;
using UniqueShaderModule = UniqueHandle<VkShaderModule>;
using UniqueSetLayout = UniqueHandle<VkDescriptorSetLayout>;
using UniqueDescriptorPool = UniqueHandle<VkDescriptorPool>;
using UniquePipelineLayout = UniqueHandle<VkPipelineLayout>;
using UniquePipeline = UniqueHandle<VkPipeline>;
using UniqueCommandPool = UniqueHandle<VkCommandPool>;
using UniqueSemaphore = UniqueHandle<VkSemaphore>;
using UniqueSwapchain = UniqueHandle<VkSwapchainKHR>;
using UniqueQueryPool = UniqueHandle<VkQueryPool>;

}  // namespace exemplar
