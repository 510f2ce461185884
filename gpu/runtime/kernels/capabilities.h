#pragma once

#include <cstdint>
#include <string>

#include "gpu/runtime/device/device.h"

namespace exemplar {

// What shaders of others may need beyond what every Vulkan 1.3 device offers.

/// Returns the features of number types, memory and subgroups that compute shaders may use.
DeviceFeatures compute_features();

/// Returns the name of a capability of SPIR-V, or "number N" for rare ones.
std::string capability_name(std::uint32_t capability);

/// Returns whether shaders may need a capability: every device has it, or one of compute_features() stands for it.
bool is_known_capability(std::uint32_t capability);

/// Returns whether a device offers a known capability.
bool offers_capability(VkPhysicalDevice device, std::uint32_t capability);

}  // namespace exemplar
