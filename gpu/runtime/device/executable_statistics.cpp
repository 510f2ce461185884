#include "gpu/runtime/device/executable_statistics.h"

#include <fmt/format.h>

#include <cstdint>

#include "gpu/runtime/device/device.h"
#include "gpu/runtime/vulkan/errors.h"
#include "gpu/runtime/vulkan/functions.h"

namespace exemplar {
namespace {

std::string value_text(const VkPipelineExecutableStatisticKHR& statistic) {
    switch (statistic.format) {
        case VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_BOOL32_KHR:
            return statistic.value.b32 ? "yes" : "no";
        case VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_INT64_KHR:
            return std::to_string(statistic.value.i64);
        case VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_UINT64_KHR:
            return std::to_string(statistic.value.u64);
        case VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_FLOAT64_KHR:
            return fmt::format("{}", statistic.value.f64);
        default:
            return {};
    }
}

std::uint32_t executable_count(VkDevice device, VkPipeline pipeline) {
    auto info = empty_structure<VkPipelineInfoKHR>(VK_STRUCTURE_TYPE_PIPELINE_INFO_KHR);
    info.pipeline = pipeline;
    std::uint32_t count = 0;
    return vkGetPipelineExecutablePropertiesKHR(device, &info, &count, nullptr) == VK_SUCCESS ? count : 0;
}

}  // namespace

bool has_executable_statistics(VkPhysicalDevice device) {
    if (!has_extension(device, VK_KHR_PIPELINE_EXECUTABLE_PROPERTIES_EXTENSION_NAME)) return false;
    auto executables = empty_structure<VkPhysicalDevicePipelineExecutablePropertiesFeaturesKHR>(
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PIPELINE_EXECUTABLE_PROPERTIES_FEATURES_KHR);
    auto features =
        empty_structure<VkPhysicalDeviceFeatures2>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, &executables);
    vkGetPhysicalDeviceFeatures2(device, &features);
    return executables.pipelineExecutableInfo == VK_TRUE;
}

std::vector<ExecutableStatistic> executable_statistics(const Device& device, VkPipeline pipeline) {
    std::vector<ExecutableStatistic> result;
    auto info = empty_structure<VkPipelineExecutableInfoKHR>(VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_INFO_KHR);
    info.pipeline = pipeline;
    const std::uint32_t executables = executable_count(device.handle(), pipeline);
    for (info.executableIndex = 0; info.executableIndex < executables; ++info.executableIndex) {
        std::uint32_t count = 0;
        if (vkGetPipelineExecutableStatisticsKHR(device.handle(), &info, &count, nullptr) != VK_SUCCESS) continue;
        std::vector<VkPipelineExecutableStatisticKHR> statistics(
            count,
            empty_structure<VkPipelineExecutableStatisticKHR>(VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_STATISTIC_KHR));
        if (vkGetPipelineExecutableStatisticsKHR(device.handle(), &info, &count, statistics.data()) != VK_SUCCESS)
            continue;
        for (const auto& statistic : statistics) result.push_back({statistic.name, value_text(statistic)});
    }
    return result;
}

}  // namespace exemplar
