#pragma once

#include <vulkan/vulkan_core.h>

#include <string>
#include <vector>

namespace exemplar {

class Device;

/// A statistic of a compiled pipeline (VK_KHR_pipeline_executable_properties), such as registers, instructions or
/// occupancy. Names and units are the driver's own.
struct ExecutableStatistic {
    std::string name;
    std::string value;
};

/// Returns whether the device offers such statistics.
bool has_executable_statistics(VkPhysicalDevice device);

/// Returns the statistics of all executables of a pipeline, one after the other. It must have been made with
/// VK_PIPELINE_CREATE_CAPTURE_STATISTICS_BIT_KHR. Empty if the driver's query fails.
std::vector<ExecutableStatistic> executable_statistics(const Device& device, VkPipeline pipeline);

}  // namespace exemplar
