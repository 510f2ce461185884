#pragma once

#include <vulkan/vulkan_core.h>

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "gpu/runtime/record/profiler.h"
#include "gpu/runtime/vulkan/unique_handle.h"

namespace exemplar {

class Device;

/// Timestamps around the dispatches and passes of one command sequence: start() and stop() are recorded, collect()
/// reads them when the work is done. Does nothing without a profiler or on a device without timestamps.
class Timestamps {
  public:
    Timestamps(Device& device, Profiler* profiler) : device_(device), profiler_(profiler) {}

    void start(VkCommandBuffer commands, std::string_view name);
    void stop(VkCommandBuffer commands, VkPipelineStageFlags2 stage);
    /// Adds the recorded times and the submission to the profiler; call it when the commands are done.
    void collect();
    /// Forgets what was recorded.
    void clear() { dispatches_.clear(); }

  private:
    bool enabled() const;
    void add_pool();
    std::uint64_t elapsed_ticks(std::size_t dispatch) const;
    Device& device_;
    Profiler* profiler_;
    std::vector<UniqueQueryPool> pools_;
    std::vector<std::string> dispatches_;
};

}  // namespace exemplar
