#pragma once

// Vulkan's functions, for sources of this project only: public headers include vulkan_core.h alone. They are variables
// of this namespace, so that a program may link the loader, or load functions in its own way: neither has these names.
// Within the namespace they hide the loader's prototypes.

#include <vulkan/vulkan_core.h>

namespace exemplar {

/// Functions that need no instance.
#define EXEMPLAR_GLOBAL_FUNCTIONS(f)                                                                    \
    f(vkCreateInstance) f(vkEnumerateInstanceExtensionProperties) f(vkEnumerateInstanceLayerProperties) \
        f(vkEnumerateInstanceVersion)

/// All others; those of extensions are null where no driver has them.
#define EXEMPLAR_INSTANCE_FUNCTIONS(f)                                                                                 \
    f(vkAcquireNextImageKHR) f(vkAllocateCommandBuffers) f(vkAllocateDescriptorSets) f(vkAllocateMemory)               \
        f(vkBeginCommandBuffer) f(vkBindBufferMemory) f(vkBindImageMemory) f(vkCmdBeginRendering) f(                   \
            vkCmdBindDescriptorSets) f(vkCmdBindIndexBuffer) f(vkCmdBindPipeline) f(vkCmdBlitImage) f(vkCmdCopyBuffer) \
            f(vkCmdCopyImageToBuffer) f(vkCmdDispatch) f(vkCmdDispatchIndirect) f(vkCmdDraw) f(vkCmdDrawIndexed) f(    \
                vkCmdDrawIndirect) f(vkCmdEndRendering) f(vkCmdFillBuffer) f(vkCmdPipelineBarrier2)                    \
                f(vkCmdPushConstants) f(vkCmdResetQueryPool) f(vkCmdSetScissor) f(vkCmdSetViewport) f(                 \
                    vkCmdWriteTimestamp2) f(vkCreateBuffer) f(vkCreateBufferView) f(vkCreateCommandPool)               \
                    f(vkCreateComputePipelines) f(vkCreateDebugUtilsMessengerEXT) f(vkCreateDescriptorPool) f(         \
                        vkCreateDescriptorSetLayout) f(vkCreateDevice) f(vkCreateGraphicsPipelines) f(vkCreateImage)   \
                        f(vkCreateImageView) f(vkCreatePipelineCache) f(vkCreatePipelineLayout) f(vkCreateQueryPool)   \
                            f(vkCreateSemaphore) f(vkCreateShaderModule) f(vkCreateSwapchainKHR) f(vkDestroyBuffer) f( \
                                vkDestroyBufferView) f(vkDestroyCommandPool) f(vkDestroyDebugUtilsMessengerEXT)        \
                                f(vkDestroyDescriptorPool) f(vkDestroyDescriptorSetLayout) f(vkDestroyDevice) f(       \
                                    vkDestroyImage) f(vkDestroyImageView) f(vkDestroyInstance) f(vkDestroyPipeline)    \
                                    f(vkDestroyPipelineCache) f(vkDestroyPipelineLayout) f(vkDestroyQueryPool) f(      \
                                        vkDestroySemaphore) f(vkDestroyShaderModule) f(vkDestroySurfaceKHR)            \
                                        f(vkDestroySwapchainKHR) f(vkDeviceWaitIdle) f(vkEndCommandBuffer) f(          \
                                            vkEnumerateDeviceExtensionProperties) f(vkEnumeratePhysicalDevices)        \
                                            f(vkFreeMemory) f(vkGetBufferMemoryRequirements) f(vkGetDeviceQueue) f(    \
                                                vkGetImageMemoryRequirements) f(vkGetPhysicalDeviceFeatures2)          \
                                                f(vkGetPhysicalDeviceFormatProperties) f(                              \
                                                    vkGetPhysicalDeviceMemoryProperties)                               \
                                                    f(vkGetPhysicalDeviceProperties) f(vkGetPhysicalDeviceProperties2) \
                                                        f(vkGetPhysicalDeviceQueueFamilyProperties)                    \
                                                            f(vkGetPhysicalDeviceSurfaceCapabilitiesKHR) f(            \
                                                                vkGetPhysicalDeviceSurfaceFormatsKHR)                  \
                                                                f(vkGetPhysicalDeviceSurfaceSupportKHR) f(             \
                                                                    vkGetPipelineCacheData)                            \
                                                                    f(vkGetPipelineExecutablePropertiesKHR) f(         \
                                                                        vkGetPipelineExecutableStatisticsKHR)          \
                                                                        f(vkGetQueryPoolResults) f(                    \
                                                                            vkGetSwapchainImagesKHR) f(vkMapMemory)    \
                                                                            f(vkQueuePresentKHR) f(vkQueueSubmit2)     \
                                                                                f(vkResetCommandPool)                  \
                                                                                    f(vkResetDescriptorPool) f(        \
                                                                                        vkSetDebugUtilsObjectNameEXT)  \
                                                                                        f(vkUpdateDescriptorSets)      \
                                                                                            f(vkWaitSemaphores)

#define EXEMPLAR_DECLARE(name) extern PFN_##name name;
EXEMPLAR_GLOBAL_FUNCTIONS(EXEMPLAR_DECLARE)
EXEMPLAR_INSTANCE_FUNCTIONS(EXEMPLAR_DECLARE)
#undef EXEMPLAR_DECLARE
extern PFN_vkGetInstanceProcAddr vkGetInstanceProcAddr;

/// Loads the system's Vulkan loader (libvulkan.so.1) and the global functions; returns false if there is none. Any
/// thread may call it, again and again.
bool load_vulkan_loader();
/// Returns the version of the loader, 0 without one.
std::uint32_t vulkan_loader_version();
/// Loads the functions that need an instance. They serve every instance. `from`: where to look them up; null: the
/// system's loader. Any thread may call it.
void load_vulkan_functions(VkInstance instance, PFN_vkGetInstanceProcAddr from = nullptr);

}  // namespace exemplar
