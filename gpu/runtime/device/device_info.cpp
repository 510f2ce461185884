#include "gpu/runtime/device/device_info.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <tuple>

#include "gpu/runtime/device/device.h"
#include "gpu/runtime/device/instance.h"
#include "gpu/runtime/device/visible_devices.h"
#include "gpu/runtime/vulkan/errors.h"
#include "gpu/runtime/vulkan/functions.h"
#include "host/core/text.h"

namespace exemplar {
namespace {

DeviceType device_type(VkPhysicalDeviceType type) {
    switch (type) {
        case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
            return DeviceType::discrete;
        case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
            return DeviceType::integrated;
        case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
            return DeviceType::virtual_gpu;
        case VK_PHYSICAL_DEVICE_TYPE_CPU:
            return DeviceType::cpu;
        default:
            return DeviceType::other;
    }
}

std::string version_text(std::uint32_t version) {
    return fmt::format("{}.{}.{}", VK_API_VERSION_MAJOR(version), VK_API_VERSION_MINOR(version),
                       VK_API_VERSION_PATCH(version));
}

// Why Exemplar cannot run on the device; empty if it can.
std::string missing_feature(VkPhysicalDevice device, std::uint32_t api_version) {
    if (api_version < VK_API_VERSION_1_3) return fmt::format("Vulkan {} is older than 1.3", version_text(api_version));
    auto features13 =
        empty_structure<VkPhysicalDeviceVulkan13Features>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES);
    auto features =
        empty_structure<VkPhysicalDeviceFeatures2>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, &features13);
    vkGetPhysicalDeviceFeatures2(device, &features);
    if (!features13.synchronization2) return "it lacks synchronization2";
    if (!features13.dynamicRendering) return "it lacks dynamic rendering";
    if (!find_compute_queue(device)) return "it has no compute queue";
    VkPhysicalDeviceMemoryProperties memory{};
    vkGetPhysicalDeviceMemoryProperties(device, &memory);
    if (memory.memoryTypeCount == 0)
        return "it has no memory: it is a driver without its hardware, as RADV_FORCE_FAMILY asks for";
    return {};
}

std::uint64_t local_memory(VkPhysicalDevice device) {
    VkPhysicalDeviceMemoryProperties memory{};
    vkGetPhysicalDeviceMemoryProperties(device, &memory);
    std::uint64_t largest = 0;
    for (std::uint32_t i = 0; i < memory.memoryHeapCount; ++i)
        if (memory.memoryHeaps[i].flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT)
            largest = std::max<std::uint64_t>(largest, memory.memoryHeaps[i].size);
    return largest;
}

void copy_limits(const VkPhysicalDeviceLimits& limits, DeviceInfo& info) {
    info.max_storage_range = limits.maxStorageBufferRange;
    info.storage_alignment = limits.minStorageBufferOffsetAlignment;
    info.max_invocations = limits.maxComputeWorkGroupInvocations;
    std::copy_n(limits.maxComputeWorkGroupCount, 3, info.max_groups.begin());
    info.max_shared_memory = limits.maxComputeSharedMemorySize;
    info.max_push_constants = limits.maxPushConstantsSize;
    info.max_texels = limits.maxTexelBufferElements;
    info.texel_alignment = limits.minTexelBufferOffsetAlignment;
    info.max_storage_buffers =
        std::min(limits.maxPerStageDescriptorStorageBuffers, limits.maxDescriptorSetStorageBuffers);
    std::copy_n(limits.maxComputeWorkGroupSize, 3, info.max_group_size.begin());
}

void copy_timestamps(VkPhysicalDevice device, float period, DeviceInfo& info) {
    const std::optional<std::uint32_t> family = find_compute_queue(device);
    if (!family) return;
    info.timestamp_bits = queue_families(device)[*family].timestampValidBits;
    info.timestamp_period = info.timestamp_bits ? period : 0.0f;
}

std::string device_list(std::span<const DeviceInfo> devices) {
    std::string list;
    for (const DeviceInfo& device : devices)
        list += fmt::format("{}{}: {} ({}{})", list.empty() ? "" : "; ", device.index, device.name,
                            to_string(device.type), device.unusable.empty() ? "" : ", unusable: " + device.unusable);
    return list;
}

std::string pci_address(VkPhysicalDevice device) {
    if (!has_extension(device, VK_EXT_PCI_BUS_INFO_EXTENSION_NAME)) return {};
    auto pci = empty_structure<VkPhysicalDevicePCIBusInfoPropertiesEXT>(
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PCI_BUS_INFO_PROPERTIES_EXT);
    auto properties =
        empty_structure<VkPhysicalDeviceProperties2>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &pci);
    vkGetPhysicalDeviceProperties2(device, &properties);
    return fmt::format("{:04x}:{:02x}:{:02x}.{:x}", pci.pciDomain, pci.pciBus, pci.pciDevice, pci.pciFunction);
}

// Suggests the nearest device name, or word of one.
std::string suggest_name(std::span<const DeviceInfo> devices, std::string_view wanted) {
    std::vector<std::string> candidates;
    for (const DeviceInfo& device : devices) {
        const std::string name = lower_case(device.name);
        candidates.push_back(name);
        for (std::size_t begin = 0; begin < name.size();) {
            const std::size_t end = std::min(name.find(' ', begin), name.size());
            if (end > begin + 2) candidates.push_back(name.substr(begin, end - begin));
            begin = end + 1;
        }
    }
    return suggestion(lower_case(wanted), candidates);
}

std::size_t best_device(std::span<const DeviceInfo> devices) {
    const auto best = std::ranges::min_element(devices, is_better);
    if (!best->unusable.empty())
        throw NoDeviceError(
            fmt::format("no usable Vulkan device among: {}; update the driver or install mesa-vulkan-drivers",
                        device_list(devices)));
    return best->index;
}

const DeviceInfo* find_device(std::span<const DeviceInfo> devices, std::string_view wanted) {
    std::size_t index = 0;
    const auto [end, error] = std::from_chars(wanted.data(), wanted.data() + wanted.size(), index);
    const bool number = error == std::errc{} && end == wanted.data() + wanted.size();
    if (number && index < devices.size()) return &devices[index];
    constexpr std::string_view k_uuid = "uuid:", k_pci = "pci:";
    for (const DeviceInfo& device : devices)
        if ((wanted.starts_with(k_uuid) && is_uuid_of(wanted.substr(k_uuid.size()), device)) ||
            (wanted.starts_with(k_pci) && is_pci_address_of(wanted.substr(k_pci.size()), device)))
            return &device;
    const std::string part = lower_case(wanted);
    const DeviceInfo* best = nullptr;
    for (const DeviceInfo& device : devices)
        if (lower_case(device.name).find(part) != std::string::npos && (!best || is_better(device, *best)))
            best = &device;
    return best;
}

}  // namespace

std::vector<VkQueueFamilyProperties> queue_families(VkPhysicalDevice device) {
    std::uint32_t count = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(device, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vkGetPhysicalDeviceQueueFamilyProperties(device, &count, families.data());
    return families;
}

std::optional<std::uint32_t> find_compute_queue(VkPhysicalDevice device) {
    const std::vector<VkQueueFamilyProperties> families = queue_families(device);
    // One queue serves compute and drawing; a device that only computes is fine too.
    for (const VkQueueFlags wanted : {VK_QUEUE_COMPUTE_BIT | VK_QUEUE_GRAPHICS_BIT, VK_QUEUE_COMPUTE_BIT + 0})
        for (std::uint32_t i = 0; i < families.size(); ++i)
            if ((families[i].queueFlags & wanted) == wanted) return i;
    return std::nullopt;
}

DeviceInfo describe(VkPhysicalDevice device, std::size_t index) {
    // Only Vulkan 1.3 knows the largest buffer; older devices leave the structure alone.
    auto buffers = empty_structure<VkPhysicalDeviceMaintenance4Properties>(
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_4_PROPERTIES);
    auto maintenance = empty_structure<VkPhysicalDeviceMaintenance3Properties>(
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_3_PROPERTIES, &buffers);
    auto subgroup = empty_structure<VkPhysicalDeviceSubgroupProperties>(
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES, &maintenance);
    auto identity =
        empty_structure<VkPhysicalDeviceIDProperties>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ID_PROPERTIES, &subgroup);
    auto driver = empty_structure<VkPhysicalDeviceDriverProperties>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES,
                                                                    &identity);
    auto properties =
        empty_structure<VkPhysicalDeviceProperties2>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &driver);
    vkGetPhysicalDeviceProperties2(device, &properties);
    const VkPhysicalDeviceProperties& core = properties.properties;

    DeviceInfo info;
    info.index = index;
    info.name = core.deviceName;
    info.type = device_type(core.deviceType);
    info.driver_name = driver.driverName;
    info.driver_version = driver.driverInfo[0] ? driver.driverInfo : version_text(core.driverVersion);
    info.driver_number = core.driverVersion;
    info.api_version = version_text(core.apiVersion);
    info.unusable = missing_feature(device, core.apiVersion);
    std::copy_n(identity.deviceUUID, VK_UUID_SIZE, info.uuid.begin());
    std::copy_n(core.pipelineCacheUUID, VK_UUID_SIZE, info.cache_uuid.begin());
    info.pci_address = pci_address(device);
    info.vendor = core.vendorID;
    info.memory = local_memory(device);
    info.max_allocation = maintenance.maxMemoryAllocationSize;
    if (buffers.maxBufferSize) info.max_allocation = std::min(info.max_allocation, buffers.maxBufferSize);
    info.subgroup_size = subgroup.subgroupSize;
    copy_limits(core.limits, info);
    copy_timestamps(device, core.limits.timestampPeriod, info);
    return info;
}

std::uint64_t buffer_limit(const DeviceInfo& info, std::uint64_t wanted) {
    return std::min({wanted, info.max_storage_range, info.max_allocation, info.memory / 8});
}

bool is_better(const DeviceInfo& a, const DeviceInfo& b) {
    // D13 in docs/portability.md. Among GPUs of one type, the one with more memory is the larger one.
    const auto rank = [](const DeviceInfo& d) {
        const bool other_cpu_driver =
            d.type == DeviceType::cpu && lower_case(d.name).find("llvmpipe") == std::string::npos;
        return std::tuple(!d.unusable.empty(), d.type, other_cpu_driver, ~d.memory);
    };
    return rank(a) < rank(b);
}

std::vector<DeviceInfo> list_devices() {
    try {
        const Instance instance(Validation::none);
        return instance.devices();
    } catch (const NoDeviceError&) {
        return {};
    }
}

std::size_t select_device(std::span<const DeviceInfo> devices, std::string_view wanted) {
    if (devices.empty())
        throw NoDeviceError("no Vulkan device found; install a driver (mesa-vulkan-drivers has one for any CPU)");
    if (wanted.empty()) return best_device(devices);
    const DeviceInfo* found = find_device(devices, wanted);
    if (!found)
        throw NoDeviceError(fmt::format("no Vulkan device '{}'{}; there are {}", wanted, suggest_name(devices, wanted),
                                        device_list(devices)));
    if (!found->unusable.empty())
        throw NoDeviceError(fmt::format("device '{}' cannot be used: {}", found->name, found->unusable));
    return found->index;
}

DeviceReport report_device(std::size_t index) {
    Device device({.name = std::to_string(index)});
    return {device.info(), measure_ceilings(device)};
}

std::string_view to_string(DeviceType type) {
    switch (type) {
        case DeviceType::discrete:
            return "discrete GPU";
        case DeviceType::integrated:
            return "integrated GPU";
        case DeviceType::virtual_gpu:
            return "virtual GPU";
        case DeviceType::cpu:
            return "CPU";
        case DeviceType::other:
            break;
    }
    return "other";
}

nlohmann::ordered_json to_json(const DeviceReport& report) {
    const DeviceInfo& info = report.info;
    nlohmann::ordered_json json = {{"index", info.index},
                                   {"name", info.name},
                                   {"type", to_string(info.type)},
                                   {"driver", info.driver_name},
                                   {"driver_version", info.driver_version},
                                   {"api_version", info.api_version},
                                   {"uuid", uuid_text(info)},
                                   {"pci_address", info.pci_address},
                                   {"usable", info.unusable.empty()},
                                   {"memory_bytes", info.memory},
                                   {"max_allocation_bytes", info.max_allocation},
                                   {"max_storage_range_bytes", info.max_storage_range},
                                   {"storage_alignment_bytes", info.storage_alignment},
                                   {"max_texels", info.max_texels},
                                   {"max_workgroup_invocations", info.max_invocations},
                                   {"max_workgroups", info.max_groups},
                                   {"max_shared_memory_bytes", info.max_shared_memory},
                                   {"max_push_constant_bytes", info.max_push_constants},
                                   {"subgroup_size", info.subgroup_size},
                                   {"timestamp_period_ns", info.timestamp_period}};
    if (!info.unusable.empty()) json["unusable_because"] = info.unusable;
    if (report.ceilings) {
        json["copy_gb_per_s"] = report.ceilings->copy_gb_per_s;
        json["fma_gflop_per_s"] = report.ceilings->fma_gflop_per_s;
        json["shared_gb_per_s"] = report.ceilings->shared_gb_per_s;
        json["texel_gb_per_s"] = report.ceilings->texel_gb_per_s;
        json["atomic_gop_per_s"] = report.ceilings->atomic_gop_per_s;
        json["launch_us"] = report.ceilings->launch_us;
    }
    return json;
}

}  // namespace exemplar
