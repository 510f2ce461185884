#pragma once

#include <volk.h>

#include <string>
#include <vector>

namespace exemplar {

class Device;

/// What a driver says of a pipeline it has compiled (VK_KHR_pipeline_executable_properties): registers, instructions,
/// occupancy; names and units are the driver's own.
struct ExecutableStatistic {
    std::string name;
    std::string value;
};

/// Whether the device can tell.
bool has_executable_statistics(VkPhysicalDevice device);

/// Of a pipeline that was made with VK_PIPELINE_CREATE_CAPTURE_STATISTICS_BIT_KHR, all its executables' one after the
/// other. Empty if the driver fails to tell.
std::vector<ExecutableStatistic> executable_statistics(const Device& device, VkPipeline pipeline);

}  // namespace exemplar
