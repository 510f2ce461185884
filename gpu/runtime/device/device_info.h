#pragma once

#include <volk.h>

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

/// What a physical device is and allows.
struct DeviceInfo {
    std::size_t index = 0;  ///< its place in list_devices()
    std::string name;
    DeviceType type = DeviceType::other;
    std::string driver_name;
    std::string driver_version;  ///< the driver's own text where it has one
    std::string api_version;     ///< "major.minor.patch"
    std::string unusable;        ///< why Exemplar cannot use it; empty if it can
    std::array<std::uint8_t, VK_UUID_SIZE> cache_uuid{};
    std::uint32_t driver_number = 0;
    std::uint64_t memory = 0;                       ///< bytes of the largest device-local heap
    std::uint64_t max_allocation = 0;               ///< bytes of one buffer
    std::uint64_t max_storage_range = 0;            ///< bytes a kernel can see through one binding
    std::uint64_t storage_alignment = 0;            ///< bytes; offsets of bindings are multiples of it
    std::uint64_t max_texels = 0;                   ///< that a kernel can see through one binding
    std::uint64_t texel_alignment = 0;              ///< bytes; offsets of bound texels are multiples of it
    std::uint32_t max_storage_buffers = 0;          ///< that one kernel can bind
    std::uint32_t max_invocations = 0;              ///< per workgroup
    std::array<std::uint32_t, 3> max_group_size{};  ///< invocations per workgroup and axis
    std::array<std::uint32_t, 3> max_groups{};
    std::uint32_t max_shared_memory = 0;   ///< bytes per workgroup
    std::uint32_t max_push_constants = 0;  ///< bytes
    std::uint32_t subgroup_size = 0;
    float timestamp_period = 0.0f;     ///< nanoseconds per tick; 0 if the device has no timestamps
    std::uint32_t timestamp_bits = 0;  ///< of the tick counter, which wraps around
};

/// Speeds measured on the device itself; what other kernels' speeds are shares of.
struct Ceilings {
    double copy_gb_per_s = 0.0;    ///< bytes read plus bytes written by the faster of a copying kernel and
                                   ///< the driver's own copy, 10^9 per second
    double fma_gflop_per_s = 0.0;  ///< float32 fused multiply-adds, two operations each, 10^9 per second
};

/// Everything `exemplar devices` prints of one device.
struct DeviceReport {
    DeviceInfo info;
    std::optional<Ceilings> ceilings{};
};

/// `wanted` bytes for each of a task's largest buffers, or less: what one binding can see, one allocation can hold and
/// several fit into the device's memory.
std::uint64_t buffer_limit(const DeviceInfo& info, std::uint64_t wanted);

/// The most iterations of all of its loops together that an invocation may be given. Mesa's llvmpipe ends all loops of
/// an invocation after 65,535, without a word.
inline constexpr std::uint32_t k_most_iterations = 32'768;

/// All Vulkan devices of this machine, unusable ones too; empty if there is no Vulkan loader or driver.
std::vector<DeviceInfo> list_devices();

/// Whether `a` is chosen before `b`: usable before unusable, then discrete, integrated, virtual, CPU (lavapipe before
/// others), then the one with more memory.
bool is_better(const DeviceInfo& a, const DeviceInfo& b);

/// The index of the wanted device: `wanted` is an index, a part of a name in any case (the best that has it; a number
/// that is no index may be one too), or empty for the best usable device. Throws NoDeviceError with the list of
/// devices, and for a wrong name the nearest, if there is none.
std::size_t select_device(std::span<const DeviceInfo> devices, std::string_view wanted);

/// Opens the device, measures its ceilings (about a second) and returns all there is to say.
DeviceReport report_device(std::size_t index);

/// "discrete GPU", "CPU", ...
std::string_view to_string(DeviceType type);

/// Fields in the order a reader wants them; sizes in bytes, speeds in the unit that the name ends with.
nlohmann::ordered_json to_json(const DeviceReport& report);

/// Copy and fused multiply-add rates, measured after a warm-up: the best of several runs.
Ceilings measure_ceilings(Device& device);

/// Fills a DeviceInfo from a physical device of a loaded instance.
DeviceInfo describe(VkPhysicalDevice device, std::size_t index);

}  // namespace exemplar
