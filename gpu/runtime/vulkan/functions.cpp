#include "gpu/runtime/vulkan/functions.h"

#include <dlfcn.h>

#include <mutex>

namespace exemplar {

// NOLINTBEGIN(readability-identifier-naming): these are Vulkan's names.
#define EXEMPLAR_GLOBAL_FUNCTION(name) PFN_##name name = nullptr;
#define EXEMPLAR_FUNCTION(name) PFN_##name name = nullptr;
#include "gpu/runtime/vulkan/functions.def"
#undef EXEMPLAR_GLOBAL_FUNCTION
#undef EXEMPLAR_FUNCTION
PFN_vkGetInstanceProcAddr vkGetInstanceProcAddr = nullptr;
// NOLINTEND(readability-identifier-naming)

namespace {

std::mutex functions_mutex;

// Sets a function unless the look-up finds none: an instance without extensions does not take away their functions.
template <typename Function>
void look_up(PFN_vkGetInstanceProcAddr from, VkInstance instance, const char* name, Function& function) {
    if (const PFN_vkVoidFunction found = from(instance, name)) function = reinterpret_cast<Function>(found);
}

void load_global_functions() {
#define EXEMPLAR_GLOBAL_FUNCTION(name) look_up(vkGetInstanceProcAddr, nullptr, #name, name);
#define EXEMPLAR_FUNCTION(name)
#include "gpu/runtime/vulkan/functions.def"
#undef EXEMPLAR_GLOBAL_FUNCTION
#undef EXEMPLAR_FUNCTION
}

}  // namespace

bool load_vulkan_loader() {
    const std::lock_guard lock(functions_mutex);
    if (vkGetInstanceProcAddr) return true;
    // The library stays open: functions are called until the program ends.
    for (const char* name : {"libvulkan.so.1", "libvulkan.so", "libvulkan.1.dylib", "libMoltenVK.dylib"}) {
        void* library = dlopen(name, RTLD_NOW | RTLD_LOCAL);
        if (!library) continue;
        vkGetInstanceProcAddr = reinterpret_cast<PFN_vkGetInstanceProcAddr>(dlsym(library, "vkGetInstanceProcAddr"));
        if (vkGetInstanceProcAddr) break;
    }
    if (!vkGetInstanceProcAddr) return false;
    load_global_functions();
    return true;
}

std::uint32_t vulkan_loader_version() {
    if (!load_vulkan_loader()) return 0;
    std::uint32_t version = VK_API_VERSION_1_0;
    if (vkEnumerateInstanceVersion) vkEnumerateInstanceVersion(&version);
    return version;
}

void load_vulkan_functions(VkInstance instance, PFN_vkGetInstanceProcAddr from) {
    if (!from) load_vulkan_loader();
    const std::lock_guard lock(functions_mutex);
    if (!from) from = vkGetInstanceProcAddr;
#define EXEMPLAR_GLOBAL_FUNCTION(name)
#define EXEMPLAR_FUNCTION(name) look_up(from, instance, #name, name);
#include "gpu/runtime/vulkan/functions.def"
#undef EXEMPLAR_GLOBAL_FUNCTION
#undef EXEMPLAR_FUNCTION
}

}  // namespace exemplar
