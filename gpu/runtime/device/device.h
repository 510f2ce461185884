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

/// What a device needs to show images in windows, as the window system says.
struct PresentationOptions {
    std::vector<std::string> instance_extensions;  ///< for surfaces
    /// Whether queues of that family can present.
    std::function<bool(VkInstance, VkPhysicalDevice, std::uint32_t family)> can_present;
};

struct DeviceOptions {
    /// An index of list_devices() or a part of a name in any case; empty: the environment's EXEMPLAR_DEVICE, else the
    /// best.
    std::string name{};
    std::optional<PresentationOptions> presentation{};  ///< none: nothing is shown in windows
    bool statistics = false;                            ///< keep what the driver says of kernels, where it can tell
};

/// An opened Vulkan device with one queue for compute, copies and drawing. Everything made from it must end before it.
/// With EXEMPLAR_VALIDATION=1 in the environment the validation layer watches; see validation_messages().
class Device {
  public:
    /// Throws NoDeviceError (no such device; the message lists those there are) or another DeviceError, such as for a
    /// device that cannot present though it should.
    explicit Device(const DeviceOptions& options = {});
    ~Device();
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;

    const DeviceInfo& info() const { return info_; }
    /// What the validation layer has complained about since the device was opened; empty without EXEMPLAR_VALIDATION=1.
    std::vector<std::string> validation_messages() const { return validation_log()->messages(); }
    /// The same, to be read after the device has ended too: objects that were left over are reported then.
    std::shared_ptr<const ValidationLog> validation_log() const { return instance_.validation_log(); }
    bool validating() const { return validating_; }

    VkInstance instance() const { return instance_.handle(); }
    VkPhysicalDevice physical() const { return physical_; }
    VkDevice handle() const { return device_; }
    VkQueue queue() const { return queue_; }
    std::uint32_t queue_family() const { return queue_family_; }
    PipelineCache& pipeline_cache() { return *pipeline_cache_; }
    /// What kernels made from now on are compiled with: at first what an earlier run has found fastest (tuning_path),
    /// unless EXEMPLAR_TUNING=0 is in the environment or that file is damaged.
    Tuning& tuning() { return tuning_; }
    const Tuning& tuning() const { return tuning_; }

    /// Whether pipelines are to be made with VK_PIPELINE_CREATE_CAPTURE_STATISTICS_BIT_KHR.
    bool keeps_statistics() const { return statistics_; }
    /// What the driver says of the kernel of this name that was made last; empty if it does not tell.
    std::vector<ExecutableStatistic> statistics_of(const std::string& kernel) const;
    void keep_statistics(const std::string& kernel, std::vector<ExecutableStatistic> statistics);

    /// Submits recorded commands; any thread may call it. `fence` is signaled when they are done.
    void submit(VkCommandBuffer commands, VkFence fence, const SubmitOrder& order = {});
    /// Hands images of swapchains back for showing, as vkQueuePresentKHR; any thread may call it.
    VkResult present(const VkPresentInfoKHR& info);
    /// Waits until the device has nothing to do.
    void wait_idle();

    /// A memory type among `allowed` bits with all `required` properties and, where there is one, all `preferred` too.
    /// Throws DeviceError if none has the required ones.
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
    mutable std::mutex statistics_mutex_;
    std::map<std::string, std::vector<ExecutableStatistic>> statistics_of_kernels_;
};

/// Whether a device offers an extension.
bool has_extension(VkPhysicalDevice device, const char* name);

}  // namespace exemplar
