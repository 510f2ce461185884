#pragma once

#include <vulkan/vulkan_core.h>

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
#include "gpu/runtime/device/staging_pool.h"
#include "gpu/runtime/device/switches.h"
#include "gpu/runtime/device/tuning.h"
#include "gpu/runtime/vulkan/host_work.h"
#include "gpu/runtime/vulkan/memory_allocator.h"

namespace exemplar {

/// Requirements of the window system on a device that shows images in windows.
struct PresentationOptions {
    std::vector<std::string> instance_extensions;  ///< for surfaces
    /// Returns whether queues of `family` can present.
    std::function<bool(VkInstance, VkPhysicalDevice, std::uint32_t family)> can_present;
};

/// Features of Vulkan 1.0 to 1.3.
struct DeviceFeatures {
    DeviceFeatures();  ///< none
    VkPhysicalDeviceFeatures core{};
    VkPhysicalDeviceVulkan11Features v11{};
    VkPhysicalDeviceVulkan12Features v12{};
    VkPhysicalDeviceVulkan13Features v13{};
};

/// Returns the features that a device offers.
DeviceFeatures offered_features(VkPhysicalDevice device);

struct DeviceOptions {
    /// What select_device accepts: an index, a UUID, a PCI address or part of a name. Empty: the environment variable
    /// EXEMPLAR_DEVICE, else the best device.
    std::string name{};
    std::optional<PresentationOptions> presentation{};  ///< none: nothing is shown in windows
    bool statistics = false;                            ///< keep the driver's statistics of kernels, if it has any
    std::optional<DeviceSwitches> switches{};           ///< none: those of the environment
    /// Opens devices that cannot run anything, too. compile() is the only use of such a device, and it is never closed.
    bool compile_only = false;
    /// Features to enable in addition to those that Exemplar needs, where the device offers them.
    DeviceFeatures features{};
};

/// A device that the program around Exemplar has opened, of Vulkan 1.3 and with the features that require_features
/// sets.
struct ExistingDevice {
    VkInstance instance = VK_NULL_HANDLE;
    VkPhysicalDevice physical = VK_NULL_HANDLE;
    VkDevice device = VK_NULL_HANDLE;
    VkQueue queue = VK_NULL_HANDLE;  ///< for compute, and for drawing if Exemplar is to draw
    std::uint32_t queue_family = 0;
    VkPhysicalDeviceVulkan12Features features12{};  ///< as given to vkCreateDevice; `pNext` does not matter
    VkPhysicalDeviceVulkan13Features features13{};
    /// Whether VK_KHR_external_memory_fd and VK_KHR_external_semaphore_fd are enabled where the device has them.
    bool shares = false;
    /// Locked while Exemplar uses the queue; null: while Exemplar does, no other thread uses it.
    std::mutex* queue_mutex = nullptr;
    /// Where to look up Vulkan's functions; null: in the system's loader (libvulkan.so.1).
    PFN_vkGetInstanceProcAddr get_instance_proc_addr = nullptr;
};

/// Sets the features that Exemplar needs, for vkCreateDevice; leaves others as they are.
void require_features(VkPhysicalDeviceVulkan12Features& features12, VkPhysicalDeviceVulkan13Features& features13);

/// An opened Vulkan device with one queue for compute, copies and drawing. Objects made from it must be destroyed
/// before it. Variables of the environment change what it does for tests: DeviceSwitches.
class Device {
  public:
    /// Throws NoDeviceError, which lists the available devices, if there is no such device; another DeviceError for
    /// other failures, e.g. if the device must present and cannot.
    explicit Device(const DeviceOptions& options = {});
    /// Uses a device of the caller's, which must outlive this. Creates on it what it needs, and destroys only that.
    /// Throws NoDeviceError if the device, its queue or its features do not suffice.
    explicit Device(const ExistingDevice& existing);
    /// Waits for Exemplar's own work.
    ~Device();
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;

    const DeviceInfo& info() const { return info_; }
    /// Returns the validation layer's messages since the device was opened; empty without EXEMPLAR_VALIDATION=1.
    std::vector<std::string> validation_messages() const { return validation_log()->messages(); }
    /// Returns the same log. It outlives the device, whose end reports objects that were not destroyed.
    std::shared_ptr<const ValidationLog> validation_log() const { return instance_.validation_log(); }
    /// Whether extensions for sharing memory and semaphores by descriptors are enabled where the device has them.
    bool enables_sharing() const { return shares_; }
    const DeviceSwitches& switches() const { return switches_; }
    /// Whether operations that the host can do as well are faster there: the device is a CPU, so that the host has
    /// the same cores without the detour (D6 in docs/portability.md). Never with EXEMPLAR_HOST=never.
    bool host_is_faster() const { return info_.type == DeviceType::cpu && switches_.prefers_host; }
    /// Whether kernels are those for cards (Shader::words, TunableParameter::on_cards), not those for CPU drivers.
    bool runs_card_kernels() const { return info_.type != DeviceType::cpu || switches_.prefers_card_kernels; }

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
    /// Returns the value of a parameter that was found fastest, else the default of such devices.
    std::uint32_t choose(const TunableParameter& parameter) const {
        return tuning_.choose(parameter, runs_card_kernels() ? parameter.on_cards : parameter.on_cpus);
    }

    /// Whether pipelines are to be made with VK_PIPELINE_CREATE_CAPTURE_STATISTICS_BIT_KHR.
    bool captures_statistics() const { return statistics_; }
    /// Returns the driver's statistics of the latest kernel of this name; empty if it has none.
    std::vector<ExecutableStatistic> statistics_of(const std::string& kernel) const;
    void store_statistics(const std::string& kernel, std::vector<ExecutableStatistic> statistics);

    /// Names a pipeline for captures and the messages of the validation layer.
    void name_pipeline(VkPipeline pipeline, const std::string& name) const;

    /// Submits recorded commands; any thread may call it.
    Ticket submit(VkCommandBuffer commands, const SubmitOrder& order = {});
    /// Waits until a submission, and all before it, are done; any thread may call it. Throws DeviceLostError if the
    /// device was lost.
    void wait(Ticket ticket);
    /// Calls vkQueuePresentKHR; any thread may call it.
    VkResult present(const VkPresentInfoKHR& info);
    /// Waits until all work is done, also that of the window system.
    void wait_idle();

    MemoryAllocator& memory() { return *memory_; }
    StagingPool& staging() { return *staging_; }
    /// Lends memory for commands that nothing is recorded in; any thread may call it.
    CommandMemory lend_commands();
    /// Takes it back once the device has finished with it.
    void return_commands(CommandMemory memory);
    HostWorkCounter& host_work() { return host_work_; }

    /// Returns a memory type among the bits `allowed` that has all `required` properties, and all `preferred` ones if
    /// there is such a type. Throws DeviceError if none has the required ones.
    std::uint32_t memory_type(std::uint32_t allowed, VkMemoryPropertyFlags required,
                              VkMemoryPropertyFlags preferred) const;
    VkMemoryPropertyFlags memory_properties(std::uint32_t type) const {
        return memory_types_.memoryTypes[type].propertyFlags;
    }

  private:
    void require_presentation(const PresentationOptions& presentation) const;
    void create(bool presents, DeviceFeatures features);
    void create_tools();
    void wait_for_own_work();
    void destroy();
    DeviceSwitches switches_;
    HostWorkCounter host_work_;
    Instance instance_;
    DeviceInfo info_;
    VkPhysicalDevice physical_ = VK_NULL_HANDLE;
    VkPhysicalDeviceMemoryProperties memory_types_{};
    VkDevice device_ = VK_NULL_HANDLE;
    VkQueue queue_ = VK_NULL_HANDLE;
    std::uint32_t queue_family_ = 0;
    bool owns_ = true, shares_ = true;
    std::mutex own_queue_mutex_;
    std::mutex* queue_mutex_ = &own_queue_mutex_;
    UniqueSemaphore timeline_;  // its value is the ticket of the last finished submission
    Ticket last_ticket_ = 0;
    std::unique_ptr<MemoryAllocator> memory_;
    std::unique_ptr<StagingPool> staging_;
    std::mutex commands_mutex_;
    std::vector<CommandMemory> idle_commands_;
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
