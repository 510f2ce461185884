#pragma once

#include <volk.h>

#include <cstddef>
#include <filesystem>

#include "gpu/runtime/device/device_info.h"

namespace exemplar {

/// What the driver keeps of compiled pipelines, on disk between runs: one file per device and driver version, in
/// $XDG_CACHE_HOME/exemplar or ~/.cache/exemplar, and none if neither variable nor HOME is set. A missing, damaged or
/// foreign file is ignored and replaced; a folder that cannot be written costs only time.
class PipelineCache {
  public:
    PipelineCache(VkDevice device, const DeviceInfo& info);
    /// Writes the file, atomically, if the cache has another size than what was loaded.
    ~PipelineCache();
    PipelineCache(const PipelineCache&) = delete;
    PipelineCache& operator=(const PipelineCache&) = delete;

    VkPipelineCache handle() const { return cache_; }
    /// Bytes taken over from the file; 0 if there was none or it was ignored.
    std::size_t loaded_bytes() const { return loaded_bytes_; }

  private:
    void save() const;
    VkDevice device_;
    std::filesystem::path path_;
    VkPipelineCache cache_ = VK_NULL_HANDLE;
    std::size_t loaded_bytes_ = 0;
};

/// Where the cache of a device lives (device_cache_path); empty if there is no folder.
std::filesystem::path pipeline_cache_path(const DeviceInfo& info);

}  // namespace exemplar
