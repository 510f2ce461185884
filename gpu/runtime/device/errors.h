#pragma once

#include <volk.h>

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

/// What a window showed images on is gone; a new surface must be made of it.
class SurfaceLostError : public DeviceError {
  public:
    using DeviceError::DeviceError;
};

/// Something larger than the device allows.
class DeviceLimitError : public DeviceError {
  public:
    DeviceLimitError(const std::string& message, std::uint64_t requested_size, std::uint64_t size_limit)
        : DeviceError(message), requested(requested_size), limit(size_limit) {}
    std::uint64_t requested;
    std::uint64_t limit;
};

/// Throws the DeviceError that belongs to a failed Vulkan call; `what` completes "cannot ...".
void check(VkResult result, std::string_view what);
/// As above; `what` makes the text, which takes longer than most calls, only when it is needed.
void check(VkResult result, std::invocable auto&& what) {
    if (result != VK_SUCCESS) check(result, std::string_view(what()));
}

/// An empty Vulkan structure of its type, for those of which only a few members are set.
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
