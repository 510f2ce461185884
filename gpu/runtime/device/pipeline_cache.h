#pragma once

#include <vulkan/vulkan_core.h>

#include <cstddef>
#include <filesystem>

#include "gpu/runtime/device/device_info.h"

namespace exemplar {

/// The driver's cache of compiled pipelines, kept on disk between runs: one file per device and driver version in
/// $XDG_CACHE_HOME/exemplar or ~/.cache/exemplar, none if neither XDG_CACHE_HOME nor HOME is set. A missing, damaged
/// or foreign file is ignored and replaced. If the folder cannot be written, every run compiles its pipelines again.
class PipelineCache {
  public:
    PipelineCache(VkDevice device, const DeviceInfo& info);
    /// Writes the file atomically if the size of the cache has changed since it was loaded.
    ~PipelineCache();
    PipelineCache(const PipelineCache&) = delete;
    PipelineCache& operator=(const PipelineCache&) = delete;

    VkPipelineCache handle() const { return cache_; }
    /// Bytes loaded from the file; 0 if there was none or it was ignored.
    std::size_t loaded_bytes() const { return loaded_bytes_; }

  private:
    void save() const;
    VkDevice device_;
    std::filesystem::path path_;
    VkPipelineCache cache_ = VK_NULL_HANDLE;
    std::size_t loaded_bytes_ = 0;
};

/// Returns the path of a device's cache file (device_cache_path); empty if there is no cache folder.
std::filesystem::path pipeline_cache_path(const DeviceInfo& info);

}  // namespace exemplar
