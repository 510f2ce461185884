#pragma once

#include <volk.h>

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "gpu/runtime/device/commands.h"
#include "gpu/runtime/device/device_info.h"
#include "gpu/runtime/device/executable_statistics.h"
#include "gpu/runtime/device/instance.h"
#include "gpu/runtime/device/pipeline_cache.h"
#include "gpu/runtime/device/tuning.h"

namespace exemplar {

/// Requirements of the window system on a device that shows images in windows.
struct PresentationOptions {
    std::vector<std::string> instance_extensions;  ///< for surfaces
    /// Returns whether queues of `family` can present.
    std::function<bool(VkInstance, VkPhysicalDevice, std::uint32_t family)> can_present;
};

struct DeviceOptions {
    /// Index in list_devices(), or part of a device's name in any case. Empty: the environment variable
    /// EXEMPLAR_DEVICE, else the best device.
    std::string name{};
    std::optional<PresentationOptions> presentation{};  ///< none: nothing is shown in windows
    bool statistics = false;                            ///< keep the driver's statistics of kernels, if it has any
    /// Opens devices that cannot run anything, too. compile() is the only use of such a device, and it is never closed.
    bool compile_only = false;
};

/// An opened Vulkan device with one queue for compute, copies and drawing. Objects made from it must be destroyed
/// before it. EXEMPLAR_VALIDATION=1 in the environment turns the validation layer on; see validation_messages().
class Device {
  public:
    /// Throws NoDeviceError, which lists the available devices, if there is no such device; another DeviceError for
    /// other failures, e.g. if the device must present and cannot.
    explicit Device(const DeviceOptions& options = {});
    ~Device();
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;

    const DeviceInfo& info() const { return info_; }
    /// Returns the validation layer's messages since the device was opened; empty without EXEMPLAR_VALIDATION=1.
    std::vector<std::string> validation_messages() const { return validation_log()->messages(); }
    /// Returns the same log. It outlives the device, whose end reports objects that were not destroyed.
    std::shared_ptr<const ValidationLog> validation_log() const { return instance_.validation_log(); }
    bool validating() const { return validating_; }

    VkInstance instance() const { return instance_.handle(); }
    VkPhysicalDevice physical() const { return physical_; }
    VkDevice handle() const { return device_; }
    VkQueue queue() const { return queue_; }
    std::uint32_t queue_family() const { return queue_family_; }
    PipelineCache& pipeline_cache() { return *pipeline_cache_; }
    /// Variants for kernels made from now on. Initially those that an earlier run found fastest (tuning_path); none
    /// if EXEMPLAR_TUNING=0 is in the environment or that file is damaged.
    Tuning& tuning() { return tuning_; }
    const Tuning& tuning() const { return tuning_; }

    /// Whether pipelines are to be made with VK_PIPELINE_CREATE_CAPTURE_STATISTICS_BIT_KHR.
    bool captures_statistics() const { return statistics_; }
    /// Returns the driver's statistics of the latest kernel of this name; empty if it has none.
    std::vector<ExecutableStatistic> statistics_of(const std::string& kernel) const;
    void store_statistics(const std::string& kernel, std::vector<ExecutableStatistic> statistics);

    /// Submits recorded commands; any thread may call it. `fence` is signaled when they are done.
    void submit(VkCommandBuffer commands, VkFence fence, const SubmitOrder& order = {});
    /// Calls vkQueuePresentKHR; any thread may call it.
    VkResult present(const VkPresentInfoKHR& info);
    /// Waits until the device is idle.
    void wait_idle();

    /// Returns a memory type among the bits `allowed` that has all `required` properties, and all `preferred` ones if
    /// there is such a type. Throws DeviceError if none has the required ones.
    std::uint32_t memory_type(std::uint32_t allowed, VkMemoryPropertyFlags required,
                              VkMemoryPropertyFlags preferred) const;
    VkMemoryPropertyFlags memory_properties(std::uint32_t type) const {
        return memory_.memoryTypes[type].propertyFlags;
    }

  private:
    void require_presentation(const PresentationOptions& presentation) const;
    void create(bool presents);
    bool validating_;
    Instance instance_;
    DeviceInfo info_;
    VkPhysicalDevice physical_ = VK_NULL_HANDLE;
    VkPhysicalDeviceMemoryProperties memory_{};
    VkDevice device_ = VK_NULL_HANDLE;
    VkQueue queue_ = VK_NULL_HANDLE;
    std::uint32_t queue_family_ = 0;
    std::mutex queue_mutex_;
    std::unique_ptr<PipelineCache> pipeline_cache_;
    Tuning tuning_;
    bool statistics_ = false;
    bool compile_only_ = false;
    mutable std::mutex statistics_mutex_;
    std::map<std::string, std::vector<ExecutableStatistic>> statistics_of_kernels_;
};

/// Whether a device offers an extension.
bool has_extension(VkPhysicalDevice device, const char* name);

}  // namespace exemplar
