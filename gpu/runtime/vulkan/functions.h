#pragma once

// Vulkan's functions, for sources of this project only: public headers include vulkan_core.h alone. They are variables
// of this namespace, so that a program may link the loader, or load functions in its own way: neither has these names.
// Within the namespace they hide the loader's prototypes.

#include <vulkan/vulkan_core.h>

namespace exemplar {

// NOLINTBEGIN(readability-identifier-naming): these are Vulkan's names.
#define EXEMPLAR_GLOBAL_FUNCTION(name) extern PFN_##name name;
#define EXEMPLAR_FUNCTION(name) extern PFN_##name name;  // null if it is of an extension that no driver has
#include "gpu/runtime/vulkan/functions.def"
#undef EXEMPLAR_GLOBAL_FUNCTION
#undef EXEMPLAR_FUNCTION
extern PFN_vkGetInstanceProcAddr vkGetInstanceProcAddr;
// NOLINTEND(readability-identifier-naming)

/// Loads the system's Vulkan loader (libvulkan.so.1) and the global functions; returns false if there is none. Any
/// thread may call it, again and again.
bool load_vulkan_loader();
/// Returns the version of the loader, 0 without one.
std::uint32_t vulkan_loader_version();
/// Loads the functions that need an instance. They serve every instance. `from`: where to look them up; null: the
/// system's loader. Any thread may call it.
void load_vulkan_functions(VkInstance instance, PFN_vkGetInstanceProcAddr from = nullptr);

}  // namespace exemplar
