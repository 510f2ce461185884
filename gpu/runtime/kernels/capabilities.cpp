#include "gpu/runtime/kernels/capabilities.h"

#include <fmt/format.h>
#include <spirv.h>

#include <algorithm>
#include <array>
#include <string_view>

namespace exemplar {
namespace {

// A capability and its feature; without one, every device has it.
struct KnownCapability {
    std::uint32_t capability;
    std::string_view name;
    VkBool32& (*feature)(DeviceFeatures&);
};

template <auto Part, auto Member>
VkBool32& feature_of(DeviceFeatures& features) {
    return features.*Part.*Member;
}

constexpr std::array<KnownCapability, 33> k_known_capabilities{
    {{SpvCapabilityMatrix, "Matrix", nullptr},
     {SpvCapabilityShader, "Shader", nullptr},
     {SpvCapabilitySampledBuffer, "SampledBuffer", nullptr},
     {SpvCapabilityImageQuery, "ImageQuery", nullptr},
     {SpvCapabilityGroupNonUniform, "GroupNonUniform", nullptr},
     {SpvCapabilityGroupNonUniformVote, "GroupNonUniformVote", nullptr},
     {SpvCapabilityGroupNonUniformArithmetic, "GroupNonUniformArithmetic", nullptr},
     {SpvCapabilityGroupNonUniformBallot, "GroupNonUniformBallot", nullptr},
     {SpvCapabilityGroupNonUniformShuffle, "GroupNonUniformShuffle", nullptr},
     {SpvCapabilityGroupNonUniformShuffleRelative, "GroupNonUniformShuffleRelative", nullptr},
     {SpvCapabilityGroupNonUniformClustered, "GroupNonUniformClustered", nullptr},
     {SpvCapabilityGroupNonUniformQuad, "GroupNonUniformQuad", nullptr},
     {SpvCapabilityFloat64, "Float64", feature_of<&DeviceFeatures::core, &VkPhysicalDeviceFeatures::shaderFloat64>},
     {SpvCapabilityInt64, "Int64", feature_of<&DeviceFeatures::core, &VkPhysicalDeviceFeatures::shaderInt64>},
     {SpvCapabilityInt16, "Int16", feature_of<&DeviceFeatures::core, &VkPhysicalDeviceFeatures::shaderInt16>},
     {SpvCapabilityStorageBuffer16BitAccess, "StorageBuffer16BitAccess",
      feature_of<&DeviceFeatures::v11, &VkPhysicalDeviceVulkan11Features::storageBuffer16BitAccess>},
     {SpvCapabilityUniformAndStorageBuffer16BitAccess, "UniformAndStorageBuffer16BitAccess",
      feature_of<&DeviceFeatures::v11, &VkPhysicalDeviceVulkan11Features::uniformAndStorageBuffer16BitAccess>},
     {SpvCapabilityStoragePushConstant16, "StoragePushConstant16",
      feature_of<&DeviceFeatures::v11, &VkPhysicalDeviceVulkan11Features::storagePushConstant16>},
     {SpvCapabilityVariablePointersStorageBuffer, "VariablePointersStorageBuffer",
      feature_of<&DeviceFeatures::v11, &VkPhysicalDeviceVulkan11Features::variablePointersStorageBuffer>},
     {SpvCapabilityVariablePointers, "VariablePointers",
      feature_of<&DeviceFeatures::v11, &VkPhysicalDeviceVulkan11Features::variablePointers>},
     {SpvCapabilityFloat16, "Float16",
      feature_of<&DeviceFeatures::v12, &VkPhysicalDeviceVulkan12Features::shaderFloat16>},
     {SpvCapabilityInt8, "Int8", feature_of<&DeviceFeatures::v12, &VkPhysicalDeviceVulkan12Features::shaderInt8>},
     {SpvCapabilityStorageBuffer8BitAccess, "StorageBuffer8BitAccess",
      feature_of<&DeviceFeatures::v12, &VkPhysicalDeviceVulkan12Features::storageBuffer8BitAccess>},
     {SpvCapabilityUniformAndStorageBuffer8BitAccess, "UniformAndStorageBuffer8BitAccess",
      feature_of<&DeviceFeatures::v12, &VkPhysicalDeviceVulkan12Features::uniformAndStorageBuffer8BitAccess>},
     {SpvCapabilityStoragePushConstant8, "StoragePushConstant8",
      feature_of<&DeviceFeatures::v12, &VkPhysicalDeviceVulkan12Features::storagePushConstant8>},
     {SpvCapabilityInt64Atomics, "Int64Atomics",
      feature_of<&DeviceFeatures::v12, &VkPhysicalDeviceVulkan12Features::shaderBufferInt64Atomics>},
     {SpvCapabilityVulkanMemoryModel, "VulkanMemoryModel",
      feature_of<&DeviceFeatures::v12, &VkPhysicalDeviceVulkan12Features::vulkanMemoryModel>},
     {SpvCapabilityVulkanMemoryModelDeviceScope, "VulkanMemoryModelDeviceScope",
      feature_of<&DeviceFeatures::v12, &VkPhysicalDeviceVulkan12Features::vulkanMemoryModelDeviceScope>},
     {SpvCapabilityDotProductInputAll, "DotProductInputAll",
      feature_of<&DeviceFeatures::v13, &VkPhysicalDeviceVulkan13Features::shaderIntegerDotProduct>},
     {SpvCapabilityDotProductInput4x8Bit, "DotProductInput4x8Bit",
      feature_of<&DeviceFeatures::v13, &VkPhysicalDeviceVulkan13Features::shaderIntegerDotProduct>},
     {SpvCapabilityDotProductInput4x8BitPacked, "DotProductInput4x8BitPacked",
      feature_of<&DeviceFeatures::v13, &VkPhysicalDeviceVulkan13Features::shaderIntegerDotProduct>},
     {SpvCapabilityDotProduct, "DotProduct",
      feature_of<&DeviceFeatures::v13, &VkPhysicalDeviceVulkan13Features::shaderIntegerDotProduct>},
     {SpvCapabilityDemoteToHelperInvocationEXT, "DemoteToHelperInvocation",
      feature_of<&DeviceFeatures::v13, &VkPhysicalDeviceVulkan13Features::shaderDemoteToHelperInvocation>}}};

const KnownCapability* known_capability(std::uint32_t capability) {
    const auto found = std::ranges::find(k_known_capabilities, capability, &KnownCapability::capability);
    return found == k_known_capabilities.end() ? nullptr : &*found;
}

}  // namespace

DeviceFeatures compute_features() {
    DeviceFeatures features;
    for (const KnownCapability& known : k_known_capabilities)
        if (known.feature) known.feature(features) = VK_TRUE;
    // No capability of their own.
    features.v12.shaderSharedInt64Atomics = VK_TRUE;
    features.v12.scalarBlockLayout = VK_TRUE;
    features.v12.shaderSubgroupExtendedTypes = VK_TRUE;
    features.v13.maintenance4 = VK_TRUE;
    features.v13.shaderZeroInitializeWorkgroupMemory = VK_TRUE;
    return features;
}

std::string capability_name(std::uint32_t capability) {
    const KnownCapability* known = known_capability(capability);
    return known ? std::string(known->name) : fmt::format("number {}", capability);
}

bool is_known_capability(std::uint32_t capability) {
    return known_capability(capability) != nullptr;
}

bool offers_capability(VkPhysicalDevice device, std::uint32_t capability) {
    const KnownCapability* known = known_capability(capability);
    if (!known || !known->feature) return known != nullptr;
    DeviceFeatures offered = offered_features(device);
    return known->feature(offered) == VK_TRUE;
}

}  // namespace exemplar
