#pragma once

#include <volk.h>

#include <utility>

namespace exemplar {

/// Owns one Vulkan object of a device. `destroy` is the address of its destroy function, e.g. &vkDestroyImage.
template <typename Handle, auto destroy>
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
        if (handle_ != VK_NULL_HANDLE) (*destroy)(device_, handle_, nullptr);
    }

    Handle get() const { return handle_; }
    /// Returns the address that a vkCreate function writes to; only for a handle that owns no object yet.
    Handle* put() { return &handle_; }

  private:
    VkDevice device_ = VK_NULL_HANDLE;
    Handle handle_ = VK_NULL_HANDLE;
};

using UniqueBuffer = UniqueHandle<VkBuffer, &vkDestroyBuffer>;
using UniqueBufferView = UniqueHandle<VkBufferView, &vkDestroyBufferView>;
using UniqueImage = UniqueHandle<VkImage, &vkDestroyImage>;
using UniqueImageView = UniqueHandle<VkImageView, &vkDestroyImageView>;
using UniqueMemory = UniqueHandle<VkDeviceMemory, &vkFreeMemory>;
using UniqueShaderModule = UniqueHandle<VkShaderModule, &vkDestroyShaderModule>;
using UniqueSetLayout = UniqueHandle<VkDescriptorSetLayout, &vkDestroyDescriptorSetLayout>;
using UniqueDescriptorPool = UniqueHandle<VkDescriptorPool, &vkDestroyDescriptorPool>;
using UniquePipelineLayout = UniqueHandle<VkPipelineLayout, &vkDestroyPipelineLayout>;
using UniquePipeline = UniqueHandle<VkPipeline, &vkDestroyPipeline>;
using UniqueCommandPool = UniqueHandle<VkCommandPool, &vkDestroyCommandPool>;
using UniqueSemaphore = UniqueHandle<VkSemaphore, &vkDestroySemaphore>;
using UniqueSwapchain = UniqueHandle<VkSwapchainKHR, &vkDestroySwapchainKHR>;
using UniqueQueryPool = UniqueHandle<VkQueryPool, &vkDestroyQueryPool>;

}  // namespace exemplar
