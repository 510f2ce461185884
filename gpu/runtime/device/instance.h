#pragma once

#include <vulkan/vulkan_core.h>

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "gpu/runtime/device/device_info.h"

namespace exemplar {

/// Warnings and errors of the validation layer. Outlives the instance, whose destruction may add messages. Any thread
/// may use it.
class ValidationLog {
  public:
    void add(std::string message) {
        const std::lock_guard lock(mutex_);
        messages_.push_back(std::move(message));
    }
    std::vector<std::string> messages() const {
        const std::lock_guard lock(mutex_);
        return messages_;
    }

  private:
    mutable std::mutex mutex_;
    std::vector<std::string> messages_;
};

/// Which checks of the validation layer are on.
enum class Validation {
    none,     ///< it is not loaded
    calls,    ///< calls, and the order of accesses (synchronization validation)
    shaders,  ///< also accesses of buffers in shaders (GPU-assisted validation)
};

/// A Vulkan instance. Collects the messages of the validation layer.
class Instance {
  public:
    /// Throws NoDeviceError if there is no loader, DeviceError if the layer VK_LAYER_KHRONOS_validation or one of
    /// `extensions` is missing.
    explicit Instance(Validation validation, const std::vector<std::string>& extensions = {});
    /// Uses an instance of the caller's, which must outlive this. `from` as for load_vulkan_functions.
    Instance(VkInstance existing, PFN_vkGetInstanceProcAddr from);
    ~Instance();
    Instance(const Instance&) = delete;
    Instance& operator=(const Instance&) = delete;

    VkInstance handle() const { return instance_; }
    std::vector<VkPhysicalDevice> physical_devices() const;
    std::vector<DeviceInfo> devices() const;
    const std::shared_ptr<ValidationLog>& validation_log() const { return log_; }
    /// Whether objects and commands can be given names for captures (VK_EXT_debug_utils).
    bool names_objects() const { return names_objects_; }

  private:
    Instance() = default;
    static VKAPI_ATTR VkBool32 VKAPI_CALL collect(VkDebugUtilsMessageSeverityFlagBitsEXT,
                                                  VkDebugUtilsMessageTypeFlagsEXT,
                                                  const VkDebugUtilsMessengerCallbackDataEXT* data, void* user);
    void create(Validation validation, const std::vector<std::string>& wanted_extensions);
    VkInstance instance_ = VK_NULL_HANDLE;
    bool owns_ = true;
    VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
    bool names_objects_ = false;
    std::shared_ptr<ValidationLog> log_ = std::make_shared<ValidationLog>();
};

std::vector<VkQueueFamilyProperties> queue_families(VkPhysicalDevice device);

/// Returns the queue family that Exemplar uses: one with compute and graphics, else one with compute alone, else
/// none.
std::optional<std::uint32_t> find_compute_queue(VkPhysicalDevice device);

}  // namespace exemplar
