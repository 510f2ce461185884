#include "gpu/runtime/device/instance.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>

#include "gpu/runtime/device/visible_devices.h"
#include "gpu/runtime/vulkan/errors.h"
#include "gpu/runtime/vulkan/functions.h"

namespace exemplar {
namespace {

constexpr const char* k_validation_layer = "VK_LAYER_KHRONOS_validation";

void require_loader() {
    if (!load_vulkan_loader())
        throw NoDeviceError(
            "no Vulkan loader found; install libvulkan1 and a driver (mesa-vulkan-drivers has one for any CPU)");
    if (vulkan_loader_version() < VK_API_VERSION_1_3)
        throw NoDeviceError("the Vulkan loader is older than 1.3; update libvulkan1");
}

bool has_layer(const char* name) {
    std::uint32_t count = 0;
    vkEnumerateInstanceLayerProperties(&count, nullptr);
    std::vector<VkLayerProperties> layers(count);
    vkEnumerateInstanceLayerProperties(&count, layers.data());
    return std::ranges::any_of(layers, [&](const VkLayerProperties& l) { return std::strcmp(l.layerName, name) == 0; });
}

bool has_instance_extension(const char* name) {
    std::uint32_t count = 0;
    vkEnumerateInstanceExtensionProperties(nullptr, &count, nullptr);
    std::vector<VkExtensionProperties> extensions(count);
    vkEnumerateInstanceExtensionProperties(nullptr, &count, extensions.data());
    return std::ranges::any_of(extensions,
                               [&](const VkExtensionProperties& e) { return std::strcmp(e.extensionName, name) == 0; });
}

VkDebugUtilsMessengerCreateInfoEXT messenger_info(PFN_vkDebugUtilsMessengerCallbackEXT callback, void* user) {
    return {
        .sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT,
        .pNext = nullptr,
        .flags = 0,
        .messageSeverity =
            VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT,
        .messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT,
        .pfnUserCallback = callback,
        .pUserData = user};
}

}  // namespace

// Delegates to the default constructor, so that the destructor runs if create() throws.
Instance::Instance(Validation validation, const std::vector<std::string>& extensions) : Instance() {
    require_loader();
    create(validation, extensions);
}

Instance::Instance(VkInstance existing, PFN_vkGetInstanceProcAddr from) : instance_(existing), owns_(false) {
    if (!from) require_loader();
    load_vulkan_functions(existing, from);
}

void Instance::create(Validation validation, const std::vector<std::string>& wanted_extensions) {
    const bool validates = validation != Validation::none;
    if (validates && !has_layer(k_validation_layer))
        throw DeviceError(
            "EXEMPLAR_VALIDATION is set but the validation layer is missing; install vulkan-validationlayers");
    std::vector<const char*> layers, extensions;
    if (validates) layers.push_back(k_validation_layer);
    // Names of kernels in captures. The layer has the extension even where no driver does.
    names_objects_ = validates || has_instance_extension(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
    if (names_objects_) extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
    // Drivers that translate to another interface, such as MoltenVK, are listed only if asked for.
    const bool portable = has_instance_extension(VK_KHR_PORTABILITY_ENUMERATION_EXTENSION_NAME);
    if (portable) extensions.push_back(VK_KHR_PORTABILITY_ENUMERATION_EXTENSION_NAME);
    for (const std::string& extension : wanted_extensions) extensions.push_back(extension.c_str());
    VkDebugUtilsMessengerCreateInfoEXT messenger = messenger_info(&Instance::collect, log_.get());
    std::vector<VkValidationFeatureEnableEXT> enabled{VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT};
    if (validation == Validation::shaders) enabled.push_back(VK_VALIDATION_FEATURE_ENABLE_GPU_ASSISTED_EXT);
    const VkValidationFeaturesEXT features{.sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT,
                                           .pNext = &messenger,
                                           .enabledValidationFeatureCount = static_cast<std::uint32_t>(enabled.size()),
                                           .pEnabledValidationFeatures = enabled.data(),
                                           .disabledValidationFeatureCount = 0,
                                           .pDisabledValidationFeatures = nullptr};
    const VkApplicationInfo application{.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
                                        .pNext = nullptr,
                                        .pApplicationName = "exemplar",
                                        .applicationVersion = 1,
                                        .pEngineName = "exemplar",
                                        .engineVersion = 1,
                                        .apiVersion = VK_API_VERSION_1_3};
    const VkInstanceCreateInfo info{
        .sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
        .pNext = validates ? &features : nullptr,
        .flags = portable ? VkInstanceCreateFlags{VK_INSTANCE_CREATE_ENUMERATE_PORTABILITY_BIT_KHR} : 0,
        .pApplicationInfo = &application,
        .enabledLayerCount = static_cast<std::uint32_t>(layers.size()),
        .ppEnabledLayerNames = layers.data(),
        .enabledExtensionCount = static_cast<std::uint32_t>(extensions.size()),
        .ppEnabledExtensionNames = extensions.data()};
    const VkResult result = vkCreateInstance(&info, nullptr, &instance_);
    if (result == VK_ERROR_INCOMPATIBLE_DRIVER)
        throw NoDeviceError("no Vulkan driver found; install one (mesa-vulkan-drivers has one for any CPU)");
    if (result == VK_ERROR_EXTENSION_NOT_PRESENT)
        throw DeviceError(fmt::format("no Vulkan driver here knows the extensions {}; update the driver",
                                      fmt::join(wanted_extensions, ", ")));
    check(result, "create a Vulkan instance");
    load_vulkan_functions(instance_);
    if (!validates) return;
    if (vkCreateDebugUtilsMessengerEXT)
        check(vkCreateDebugUtilsMessengerEXT(instance_, &messenger, nullptr, &messenger_),
              "listen to the validation layer");
}

Instance::~Instance() {
    if (messenger_) vkDestroyDebugUtilsMessengerEXT(instance_, messenger_, nullptr);
    if (instance_ && owns_) vkDestroyInstance(instance_, nullptr);
}

VkBool32 Instance::collect(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                           const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) {
    static_cast<ValidationLog*>(user)->add(data->pMessage);
    return VK_FALSE;
}

std::vector<VkPhysicalDevice> Instance::physical_devices() const {
    std::uint32_t count = 0;
    if (vkEnumeratePhysicalDevices(instance_, &count, nullptr) != VK_SUCCESS) return {};
    std::vector<VkPhysicalDevice> devices(count);
    const VkResult result = vkEnumeratePhysicalDevices(instance_, &count, devices.data());
    if (result != VK_INCOMPLETE) check(result, "list the Vulkan devices");
    devices.resize(count);
    return devices;
}

std::vector<DeviceInfo> Instance::devices() const {
    std::vector<DeviceInfo> infos;
    for (VkPhysicalDevice device : physical_devices()) infos.push_back(describe(device, infos.size()));
    hide_devices_of_others(infos, [](const char* variable) { return std::getenv(variable); });
    return infos;
}

}  // namespace exemplar
