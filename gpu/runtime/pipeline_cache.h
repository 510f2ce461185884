#pragma once

#include <volk.h>

#include <cstddef>
#include <filesystem>

#include "gpu/runtime/device_info.h"

namespace exemplar {

/// Compiled pipelines kept on disk between runs, one file per device and driver version, in $XDG_CACHE_HOME/exemplar or
/// ~/.cache/exemplar. A missing, damaged or foreign file is ignored; a folder that cannot be written costs only time.
class PipelineCache {
  public:
    PipelineCache(VkDevice device, const DeviceInfo& info);
    /// Saves the cache if it grew.
    ~PipelineCache();
    PipelineCache(const PipelineCache&) = delete;
    PipelineCache& operator=(const PipelineCache&) = delete;

    VkPipelineCache handle() const { return cache_; }
    /// Writes the file, atomically, if the cache has changed since it was loaded. Throws nothing.
    void save() noexcept;
    /// The file; empty if neither XDG_CACHE_HOME nor HOME is set.
    const std::filesystem::path& path() const { return path_; }
    /// Bytes taken over from the file; 0 if there was none or it was ignored.
    std::size_t loaded_bytes() const { return loaded_bytes_; }

  private:
    VkDevice device_;
    std::filesystem::path path_;
    VkPipelineCache cache_ = VK_NULL_HANDLE;
    std::size_t loaded_bytes_ = 0;
    std::size_t saved_bytes_ = 0;
};

/// Where the cache of a device lives: FOLDER/pipelines-UUID-DRIVER.bin.
std::filesystem::path pipeline_cache_path(const DeviceInfo& info);

}  // namespace exemplar
