#pragma once

#include <vulkan/vulkan_core.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace exemplar {

class Device;

enum class DeviceType { discrete, integrated, virtual_gpu, cpu, other };

/// Properties and limits of a physical device.
struct DeviceInfo {
    std::size_t index = 0;  ///< its place in list_devices()
    std::string name;
    DeviceType type = DeviceType::other;
    std::string driver_name;
    std::string driver_version;                           ///< the driver's own text where it has one
    std::string api_version;                              ///< "major.minor.patch"
    std::string unusable;                                 ///< why Exemplar cannot use it; empty if it can
    std::array<std::uint8_t, VK_UUID_SIZE> uuid{};        ///< of the device, the same in all programs and APIs
    std::array<std::uint8_t, VK_UUID_SIZE> cache_uuid{};  ///< of the driver's compiled pipelines
    std::string pci_address;                              ///< "0000:41:00.0"; empty if the driver does not tell
    std::uint32_t vendor = 0;                             ///< PCI number of the vendor
    std::uint32_t driver_number = 0;
    std::uint64_t memory = 0;                       ///< bytes of the largest device-local heap
    std::uint64_t max_allocation = 0;               ///< bytes of one buffer
    std::uint64_t max_storage_range = 0;            ///< bytes that one storage binding can cover
    std::uint64_t storage_alignment = 0;            ///< bytes; offsets of storage bindings are multiples of it
    std::uint64_t max_texels = 0;                   ///< texels that one binding can cover
    std::uint64_t texel_alignment = 0;              ///< bytes; offsets of texel bindings are multiples of it
    std::uint32_t max_storage_buffers = 0;          ///< storage buffers that one kernel can bind
    std::uint32_t max_invocations = 0;              ///< per workgroup
    std::array<std::uint32_t, 3> max_group_size{};  ///< invocations per workgroup and axis
    std::array<std::uint32_t, 3> max_groups{};
    std::uint32_t max_shared_memory = 0;   ///< bytes per workgroup
    std::uint32_t max_push_constants = 0;  ///< bytes
    std::uint32_t subgroup_size = 0;
    float timestamp_period = 0.0f;     ///< nanoseconds per tick; 0 if the device has no timestamps
    std::uint32_t timestamp_bits = 0;  ///< width of the tick counter, which wraps around
};

/// Peak speeds measured on the device. Speeds of kernels are reported as shares of them.
struct Ceilings {
    double copy_gb_per_s = 0.0;    ///< 10^9 bytes per second, read plus written, by a copying kernel or the
                                   ///< driver's copy command, whichever is faster
    double fma_gflop_per_s = 0.0;  ///< float32 fused multiply-adds, two operations each, 10^9 per second
};

/// Everything `exemplar devices` prints of one device.
struct DeviceReport {
    DeviceInfo info;
    std::optional<Ceilings> ceilings{};
};

/// Returns the bytes to use for each of a task's largest buffers: `wanted`, or less so that one binding can cover it,
/// one allocation can hold it and eight of them fit into the device's memory.
std::uint64_t buffer_limit(const DeviceInfo& info, std::uint64_t wanted);

/// Maximum number of iterations of an invocation, over all of its loops together: D1 in docs/portability.md.
inline constexpr std::uint32_t k_max_iterations = 32'768;

/// Returns all Vulkan devices of this machine, also unusable ones; empty if there is no Vulkan loader or driver.
std::vector<DeviceInfo> list_devices();

/// Returns whether `a` is preferred to `b`. Usable devices come first, then discrete, integrated, virtual and CPU
/// ones in this order (among CPU drivers D13 in docs/portability.md), then those with more memory.
bool is_better(const DeviceInfo& a, const DeviceInfo& b);

/// Returns the index of the device that `wanted` names: an index, "uuid:" and a UUID or its beginning, "pci:" and a PCI
/// address, or part of a name in any case (the best match; a number that is no index counts as part of a name), or
/// empty for the best usable device. Throws NoDeviceError, with the list of devices and the nearest name, if there is
/// no such device or it is unusable.
std::size_t select_device(std::span<const DeviceInfo> devices, std::string_view wanted);

/// Opens the device, measures its ceilings (about a second) and returns the full report.
DeviceReport report_device(std::size_t index);

/// "discrete GPU", "CPU", ...
std::string_view to_string(DeviceType type);

/// Describes a report as JSON. Sizes are in bytes, speeds in the unit that the key ends with.
nlohmann::ordered_json to_json(const DeviceReport& report);

/// Measures the rates of copies and fused multiply-adds: the best of several runs after a warm-up.
Ceilings measure_ceilings(Device& device);

/// Returns the DeviceInfo of a physical device of a loaded instance.
DeviceInfo describe(VkPhysicalDevice device, std::size_t index);

}  // namespace exemplar
