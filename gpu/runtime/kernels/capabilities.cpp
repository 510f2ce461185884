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

#define EXEMPLAR_FEATURE(part, member) [](DeviceFeatures& features) -> VkBool32& { return features.part.member; }
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
     {SpvCapabilityFloat64, "Float64", EXEMPLAR_FEATURE(core, shaderFloat64)},
     {SpvCapabilityInt64, "Int64", EXEMPLAR_FEATURE(core, shaderInt64)},
     {SpvCapabilityInt16, "Int16", EXEMPLAR_FEATURE(core, shaderInt16)},
     {SpvCapabilityStorageBuffer16BitAccess, "StorageBuffer16BitAccess",
      EXEMPLAR_FEATURE(v11, storageBuffer16BitAccess)},
     {SpvCapabilityUniformAndStorageBuffer16BitAccess, "UniformAndStorageBuffer16BitAccess",
      EXEMPLAR_FEATURE(v11, uniformAndStorageBuffer16BitAccess)},
     {SpvCapabilityStoragePushConstant16, "StoragePushConstant16", EXEMPLAR_FEATURE(v11, storagePushConstant16)},
     {SpvCapabilityVariablePointersStorageBuffer, "VariablePointersStorageBuffer",
      EXEMPLAR_FEATURE(v11, variablePointersStorageBuffer)},
     {SpvCapabilityVariablePointers, "VariablePointers", EXEMPLAR_FEATURE(v11, variablePointers)},
     {SpvCapabilityFloat16, "Float16", EXEMPLAR_FEATURE(v12, shaderFloat16)},
     {SpvCapabilityInt8, "Int8", EXEMPLAR_FEATURE(v12, shaderInt8)},
     {SpvCapabilityStorageBuffer8BitAccess, "StorageBuffer8BitAccess", EXEMPLAR_FEATURE(v12, storageBuffer8BitAccess)},
     {SpvCapabilityUniformAndStorageBuffer8BitAccess, "UniformAndStorageBuffer8BitAccess",
      EXEMPLAR_FEATURE(v12, uniformAndStorageBuffer8BitAccess)},
     {SpvCapabilityStoragePushConstant8, "StoragePushConstant8", EXEMPLAR_FEATURE(v12, storagePushConstant8)},
     {SpvCapabilityInt64Atomics, "Int64Atomics", EXEMPLAR_FEATURE(v12, shaderBufferInt64Atomics)},
     {SpvCapabilityVulkanMemoryModel, "VulkanMemoryModel", EXEMPLAR_FEATURE(v12, vulkanMemoryModel)},
     {SpvCapabilityVulkanMemoryModelDeviceScope, "VulkanMemoryModelDeviceScope",
      EXEMPLAR_FEATURE(v12, vulkanMemoryModelDeviceScope)},
     {SpvCapabilityDotProductInputAll, "DotProductInputAll", EXEMPLAR_FEATURE(v13, shaderIntegerDotProduct)},
     {SpvCapabilityDotProductInput4x8Bit, "DotProductInput4x8Bit", EXEMPLAR_FEATURE(v13, shaderIntegerDotProduct)},
     {SpvCapabilityDotProductInput4x8BitPacked, "DotProductInput4x8BitPacked",
      EXEMPLAR_FEATURE(v13, shaderIntegerDotProduct)},
     {SpvCapabilityDotProduct, "DotProduct", EXEMPLAR_FEATURE(v13, shaderIntegerDotProduct)},
     {SpvCapabilityDemoteToHelperInvocationEXT, "DemoteToHelperInvocation",
      EXEMPLAR_FEATURE(v13, shaderDemoteToHelperInvocation)}}};
#undef EXEMPLAR_FEATURE

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
