#include "gpu/runtime/device/device.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdlib>
#include <cstring>

#include "gpu/runtime/vulkan/errors.h"
#include "gpu/runtime/vulkan/functions.h"

namespace exemplar {
namespace {

std::string environment(const char* name) {
    const char* value = std::getenv(name);
    return value ? value : "";
}

// A damaged file is ignored, which costs only speed; `exemplar doctor` reports it.
Tuning load_tuning(const DeviceInfo& info) {
    if (environment("EXEMPLAR_TUNING") == "0") return {};
    try {
        return Tuning::load(tuning_path(info));
    } catch (const Error&) {
        return {};
    }
}

// To a driver without its hardware, a device lacks memory but can compile.
std::vector<DeviceInfo> without_faults(std::vector<DeviceInfo> devices) {
    for (DeviceInfo& device : devices) device.unusable.clear();
    return devices;
}

// Returns a feature that an existing device lacks; empty if none.
std::string missing_feature(const ExistingDevice& existing) {
    if (!existing.features12.timelineSemaphore) return "timelineSemaphore";
    if (!existing.features13.synchronization2) return "synchronization2";
    if (!existing.features13.dynamicRendering) return "dynamicRendering";
    return {};
}

// Drops the features of a structure that a device does not offer. After the structure's type and chain, all members are
// VkBool32.
template <typename Features>
void keep_offered(Features& features, const Features& offered, std::size_t first) {
    auto* const own = reinterpret_cast<unsigned char*>(&features);
    const auto* const other = reinterpret_cast<const unsigned char*>(&offered);
    for (std::size_t i = first; i < sizeof(Features); ++i) own[i] &= other[i];
}

Validation validation_of(const DeviceSwitches& switches) {
    if (!switches.validates) return Validation::none;
    return switches.checks_shaders ? Validation::shaders : Validation::calls;
}

}  // namespace

void require_features(VkPhysicalDeviceVulkan12Features& features12, VkPhysicalDeviceVulkan13Features& features13) {
    features12.timelineSemaphore = VK_TRUE;
    features13.synchronization2 = VK_TRUE;
    features13.dynamicRendering = VK_TRUE;
}

DeviceFeatures::DeviceFeatures() {
    v11.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_FEATURES;
    v12.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
    v13.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES;
}

DeviceFeatures offered_features(VkPhysicalDevice device) {
    DeviceFeatures offered;
    offered.v11.pNext = &offered.v12;
    offered.v12.pNext = &offered.v13;
    auto all = empty_structure<VkPhysicalDeviceFeatures2>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, &offered.v11);
    vkGetPhysicalDeviceFeatures2(device, &all);
    offered.core = all.features;
    offered.v11.pNext = offered.v12.pNext = nullptr;
    return offered;
}

bool has_extension(VkPhysicalDevice device, const char* name) {
    std::uint32_t count = 0;
    vkEnumerateDeviceExtensionProperties(device, nullptr, &count, nullptr);
    std::vector<VkExtensionProperties> extensions(count);
    vkEnumerateDeviceExtensionProperties(device, nullptr, &count, extensions.data());
    return std::ranges::any_of(extensions,
                               [&](const VkExtensionProperties& e) { return std::strcmp(e.extensionName, name) == 0; });
}

Device::Device(const DeviceOptions& options)
    : switches_(options.switches ? *options.switches : environment_switches()),
      instance_(validation_of(switches_),
                options.presentation ? options.presentation->instance_extensions : std::vector<std::string>{}),
      compile_only_(options.compile_only) {
    const std::vector<DeviceInfo> devices = compile_only_ ? without_faults(instance_.devices()) : instance_.devices();
    const std::size_t index =
        select_device(devices, options.name.empty() ? environment("EXEMPLAR_DEVICE") : options.name);
    info_ = devices[index];
    physical_ = instance_.physical_devices()[index];
    queue_family_ = find_compute_queue(physical_).value();
    vkGetPhysicalDeviceMemoryProperties(physical_, &memory_types_);
    if (options.presentation) require_presentation(*options.presentation);
    statistics_ = options.statistics && has_executable_statistics(physical_);
    tuning_ = load_tuning(info_);
    create(options.presentation.has_value(), options.features);
    vkGetDeviceQueue(device_, queue_family_, 0, &queue_);
    if (compile_only_) return;
    try {
        create_tools();
    } catch (...) {
        destroy();
        throw;
    }
}

Device::Device(const ExistingDevice& existing)
    : switches_(environment_switches()),
      instance_(existing.instance, existing.get_instance_proc_addr),
      info_(describe(existing.physical, 0)),
      physical_(existing.physical),
      device_(existing.device),
      queue_(existing.queue),
      queue_family_(existing.queue_family),
      owns_(false),
      shares_(existing.shares),
      queue_mutex_(existing.queue_mutex ? existing.queue_mutex : &own_queue_mutex_) {
    if (!info_.unusable.empty())
        throw NoDeviceError(fmt::format("device '{}' cannot be used: {}", info_.name, info_.unusable));
    if (const std::string lack = missing_feature(existing); !lack.empty())
        throw NoDeviceError(
            fmt::format("device '{}' was opened without {}; see exemplar::require_features", info_.name, lack));
    vkGetPhysicalDeviceMemoryProperties(physical_, &memory_types_);
    tuning_ = load_tuning(info_);
    try {
        create_tools();
    } catch (...) {
        destroy();
        throw;
    }
}

// Creates what needs the opened device.
void Device::create_tools() {
    memory_ = std::make_unique<MemoryAllocator>(device_, memory_types_, host_work_);
    staging_ = std::make_unique<StagingPool>(*this);
    auto type = empty_structure<VkSemaphoreTypeCreateInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO);
    type.semaphoreType = VK_SEMAPHORE_TYPE_TIMELINE;
    const auto info = empty_structure<VkSemaphoreCreateInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO, &type);
    timeline_ = UniqueSemaphore(device_);
    check(vkCreateSemaphore(device_, &info, nullptr, timeline_.put()), "make a semaphore");
    pipeline_cache_ = std::make_unique<PipelineCache>(device_, info_);
}

void Device::destroy() {
    pipeline_cache_.reset();
    idle_commands_.clear();
    timeline_ = UniqueSemaphore();
    staging_.reset();
    memory_.reset();
    if (owns_) vkDestroyDevice(device_, nullptr);
}

// Requires that the queue for compute and drawing can present too, as it can with drivers that have windows.
void Device::require_presentation(const PresentationOptions& presentation) const {
    if (has_extension(physical_, VK_KHR_SWAPCHAIN_EXTENSION_NAME) &&
        presentation.can_present(instance_.handle(), physical_, queue_family_))
        return;
    throw DeviceError(
        fmt::format("device '{}' cannot show images in a window; choose another with --device", info_.name));
}

void Device::create(bool presents, DeviceFeatures features) {
    const DeviceFeatures offered = offered_features(physical_);
    keep_offered(features.core, offered.core, 0);
    keep_offered(features.v11, offered.v11, offsetof(VkPhysicalDeviceVulkan11Features, storageBuffer16BitAccess));
    keep_offered(features.v12, offered.v12, offsetof(VkPhysicalDeviceVulkan12Features, samplerMirrorClampToEdge));
    keep_offered(features.v13, offered.v13, offsetof(VkPhysicalDeviceVulkan13Features, robustImageAccess));
    const float priority = 1.0f;
    const VkDeviceQueueCreateInfo queue{.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                        .pNext = nullptr,
                                        .flags = 0,
                                        .queueFamilyIndex = queue_family_,
                                        .queueCount = 1,
                                        .pQueuePriorities = &priority};
    require_features(features.v12, features.v13);
    features.v11.pNext = &features.v12;
    features.v12.pNext = &features.v13;
    auto enabled =
        empty_structure<VkPhysicalDeviceFeatures2>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, &features.v11);
    // Accesses out of bounds then do no harm before the validation layer reports them; all devices offer it.
    features.core.robustBufferAccess = switches_.validates ? VK_TRUE : VK_FALSE;
    enabled.features = features.core;
    auto executables = empty_structure<VkPhysicalDevicePipelineExecutablePropertiesFeaturesKHR>(
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PIPELINE_EXECUTABLE_PROPERTIES_FEATURES_KHR);
    executables.pipelineExecutableInfo = VK_TRUE;
    std::vector<const char*> extensions;
    if (presents) extensions.push_back(VK_KHR_SWAPCHAIN_EXTENSION_NAME);
    constexpr const char* k_portability_subset = "VK_KHR_portability_subset";  // where offered, it must be enabled
    for (const char* name :
         {k_portability_subset, VK_KHR_EXTERNAL_MEMORY_FD_EXTENSION_NAME, VK_KHR_EXTERNAL_SEMAPHORE_FD_EXTENSION_NAME})
        if (has_extension(physical_, name)) extensions.push_back(name);
    if (statistics_) {
        extensions.push_back(VK_KHR_PIPELINE_EXECUTABLE_PROPERTIES_EXTENSION_NAME);
        features.v13.pNext = &executables;
    }
    const VkDeviceCreateInfo info{.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                  .pNext = &enabled,
                                  .flags = 0,
                                  .queueCreateInfoCount = 1,
                                  .pQueueCreateInfos = &queue,
                                  .enabledLayerCount = 0,
                                  .ppEnabledLayerNames = nullptr,
                                  .enabledExtensionCount = static_cast<std::uint32_t>(extensions.size()),
                                  .ppEnabledExtensionNames = extensions.data(),
                                  .pEnabledFeatures = nullptr};
    check(vkCreateDevice(physical_, &info, nullptr, &device_),
          [&] { return fmt::format("open device '{}'", info_.name); });
}

Device::~Device() {
    // D20 in docs/portability.md: some devices crash when they are waited for or destroyed.
    if (!device_ || compile_only_) return;
    if (owns_)
        vkDeviceWaitIdle(device_);
    else
        wait_for_own_work();
    destroy();
}

// The rest of the program's work goes on.
void Device::wait_for_own_work() {
    try {
        wait(last_ticket_);
    } catch (const DeviceError&) {
        // A lost device runs nothing to wait for.
    }
}

std::vector<ExecutableStatistic> Device::statistics_of(const std::string& kernel) const {
    const std::lock_guard lock(statistics_mutex_);
    const auto found = statistics_of_kernels_.find(kernel);
    return found == statistics_of_kernels_.end() ? std::vector<ExecutableStatistic>{} : found->second;
}

void Device::store_statistics(const std::string& kernel, std::vector<ExecutableStatistic> statistics) {
    const std::lock_guard lock(statistics_mutex_);
    statistics_of_kernels_[kernel] = std::move(statistics);
}

Ticket Device::submit(VkCommandBuffer commands, const SubmitOrder& order) {
    const VkCommandBufferSubmitInfo command_info{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO,
                                                 .pNext = nullptr,
                                                 .commandBuffer = commands,
                                                 .deviceMask = 0};
    auto wait = empty_structure<VkSemaphoreSubmitInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO);
    wait.semaphore = order.wait;
    wait.value = order.wait_value;
    wait.stageMask = order.wait_stage;
    std::array<VkSemaphoreSubmitInfo, 2> signals{};
    for (VkSemaphoreSubmitInfo& signal : signals) {
        signal.sType = VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO;
        signal.stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    }
    signals[0].semaphore = timeline_.get();
    signals[1].semaphore = order.signal;
    signals[1].value = order.signal_value;
    auto info = empty_structure<VkSubmitInfo2>(VK_STRUCTURE_TYPE_SUBMIT_INFO_2);
    info.commandBufferInfoCount = 1;
    info.pCommandBufferInfos = &command_info;
    info.waitSemaphoreInfoCount = order.wait ? 1 : 0;
    info.pWaitSemaphoreInfos = &wait;
    info.signalSemaphoreInfoCount = order.signal ? 2 : 1;
    info.pSignalSemaphoreInfos = signals.data();
    const std::lock_guard lock(*queue_mutex_);
    signals[0].value = last_ticket_ + 1;
    check(vkQueueSubmit2(queue_, 1, &info, VK_NULL_HANDLE),
          [&] { return fmt::format("submit work to device '{}'", info_.name); });
    host_work_.add(HostTask::submission);
    return ++last_ticket_;
}

void Device::wait(Ticket ticket) {
    if (ticket == 0) return;
    host_work_.add(HostTask::wait);
    const auto doing = [&] { return fmt::format("finish the work on device '{}'", info_.name); };
    // With GPU-assisted validation, the layer (1.3.239) adds ten seconds to each wait for a semaphore.
    if (switches_.checks_shaders) {
        const std::lock_guard lock(*queue_mutex_);
        check(vkQueueWaitIdle(queue_), doing);
        return;
    }
    const VkSemaphore timeline = timeline_.get();
    auto info = empty_structure<VkSemaphoreWaitInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO);
    info.semaphoreCount = 1;
    info.pSemaphores = &timeline;
    info.pValues = &ticket;
    check(vkWaitSemaphores(device_, &info, UINT64_MAX), doing);
}

CommandMemory Device::lend_commands() {
    {
        const std::lock_guard lock(commands_mutex_);
        if (!idle_commands_.empty()) {
            CommandMemory memory = std::move(idle_commands_.back());
            idle_commands_.pop_back();
            return memory;
        }
    }
    CommandMemory memory{.pool = UniqueCommandPool(device_)};
    auto pool = empty_structure<VkCommandPoolCreateInfo>(VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO);
    pool.flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT;
    pool.queueFamilyIndex = queue_family_;
    check(vkCreateCommandPool(device_, &pool, nullptr, memory.pool.put()), "make a command pool");
    const VkCommandBufferAllocateInfo allocate{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                               .pNext = nullptr,
                                               .commandPool = memory.pool.get(),
                                               .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                               .commandBufferCount = 1};
    check(vkAllocateCommandBuffers(device_, &allocate, &memory.buffer), "make a command buffer");
    return memory;
}

// What was recorded and not submitted is dropped.
void Device::return_commands(CommandMemory memory) {
    vkResetCommandPool(device_, memory.pool.get(), 0);
    const std::lock_guard lock(commands_mutex_);
    idle_commands_.push_back(std::move(memory));
}

void Device::name_pipeline(VkPipeline pipeline, const std::string& name) const {
    if (!instance_.names_objects() || !vkSetDebugUtilsObjectNameEXT) return;
    auto info = empty_structure<VkDebugUtilsObjectNameInfoEXT>(VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT);
    info.objectType = VK_OBJECT_TYPE_PIPELINE;
    info.objectHandle = reinterpret_cast<std::uint64_t>(pipeline);
    info.pObjectName = name.c_str();
    vkSetDebugUtilsObjectNameEXT(device_, &info);
}

VkResult Device::present(const VkPresentInfoKHR& info) {
    const std::lock_guard lock(*queue_mutex_);
    return vkQueuePresentKHR(queue_, &info);
}

void Device::wait_idle() {
    const std::lock_guard lock(*queue_mutex_);
    host_work_.add(HostTask::wait);
    check(vkDeviceWaitIdle(device_), [&] { return fmt::format("wait for device '{}'", info_.name); });
}

std::uint32_t Device::memory_type(std::uint32_t allowed, VkMemoryPropertyFlags required,
                                  VkMemoryPropertyFlags preferred) const {
    for (const VkMemoryPropertyFlags wanted : {required | preferred, required})
        for (std::uint32_t i = 0; i < memory_types_.memoryTypeCount; ++i)
            if ((allowed >> i & 1) && (memory_properties(i) & wanted) == wanted) return i;
    throw DeviceError(fmt::format("device '{}' has no memory of the needed kind (Vulkan property flags {:#x})",
                                  info_.name, required));
}

}  // namespace exemplar
