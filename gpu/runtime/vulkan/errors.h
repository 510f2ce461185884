#pragma once

#include <vulkan/vulkan_core.h>

#include <concepts>
#include <cstdint>
#include <string>
#include <string_view>

#include "host/core/device_memory_error.h"
#include "host/core/errors.h"

namespace exemplar {

/// No usable Vulkan device, or none of the wanted name.
class NoDeviceError : public DeviceError {
  public:
    using DeviceError::DeviceError;
};

/// The device stopped answering; everything on it is gone. A new Device must be opened.
class DeviceLostError : public DeviceError {
  public:
    using DeviceError::DeviceError;
};

/// The surface of a window is lost; a new one must be made.
class SurfaceLostError : public DeviceError {
  public:
    using DeviceError::DeviceError;
};

/// A request exceeds a limit of the device.
class DeviceLimitError : public DeviceError {
  public:
    DeviceLimitError(const std::string& message, std::uint64_t requested_size, std::uint64_t size_limit)
        : DeviceError(message), requested(requested_size), limit(size_limit) {}
    std::uint64_t requested;
    std::uint64_t limit;
};

/// Throws the matching DeviceError if a Vulkan call failed; `what` completes the message "cannot ...".
void check(VkResult result, std::string_view what);
/// The same; `what` returns the text. It is called only on failure, as making the text takes longer than most calls.
void check(VkResult result, std::invocable auto&& what) {
    if (result != VK_SUCCESS) check(result, std::string_view(what()));
}

/// Returns a zeroed Vulkan structure with its type set, for structures of which only a few members are set.
template <typename T>
T empty_structure(VkStructureType type, void* next = nullptr) {
    T structure{};
    structure.sType = type;
    structure.pNext = next;
    return structure;
}

/// A Vulkan result's name, e.g. "VK_ERROR_DEVICE_LOST".
std::string result_name(VkResult result);

/// 1536 as "1.5 KiB".
std::string format_bytes(std::uint64_t bytes);

}  // namespace exemplar
