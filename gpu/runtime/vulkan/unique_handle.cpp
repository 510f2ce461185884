#include "gpu/runtime/vulkan/unique_handle.h"

#include "gpu/runtime/vulkan/functions.h"

namespace exemplar {

void destroy(VkDevice device, VkBuffer handle) {
    vkDestroyBuffer(device, handle, nullptr);
}
void destroy(VkDevice device, VkBufferView handle) {
    vkDestroyBufferView(device, handle, nullptr);
}
void destroy(VkDevice device, VkImage handle) {
    vkDestroyImage(device, handle, nullptr);
}
void destroy(VkDevice device, VkImageView handle) {
    vkDestroyImageView(device, handle, nullptr);
}
void destroy(VkDevice device, VkDeviceMemory handle) {
    vkFreeMemory(device, handle, nullptr);
}
void destroy(VkDevice device, VkShaderModule handle) {
    vkDestroyShaderModule(device, handle, nullptr);
}
void destroy(VkDevice device, VkDescriptorSetLayout handle) {
    vkDestroyDescriptorSetLayout(device, handle, nullptr);
}
void destroy(VkDevice device, VkDescriptorPool handle) {
    vkDestroyDescriptorPool(device, handle, nullptr);
}
void destroy(VkDevice device, VkPipelineLayout handle) {
    vkDestroyPipelineLayout(device, handle, nullptr);
}
void destroy(VkDevice device, VkPipeline handle) {
    vkDestroyPipeline(device, handle, nullptr);
}
void destroy(VkDevice device, VkCommandPool handle) {
    vkDestroyCommandPool(device, handle, nullptr);
}
void destroy(VkDevice device, VkSemaphore handle) {
    vkDestroySemaphore(device, handle, nullptr);
}
void destroy(VkDevice device, VkSwapchainKHR handle) {
    vkDestroySwapchainKHR(device, handle, nullptr);
}
void destroy(VkDevice device, VkQueryPool handle) {
    vkDestroyQueryPool(device, handle, nullptr);
}

}  // namespace exemplar
