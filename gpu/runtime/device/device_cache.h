#pragma once

#include <filesystem>
#include <string_view>

#include "gpu/runtime/device/device_info.h"

namespace exemplar {

/// Returns the path of a cache file that belongs to a device and its driver version: STEM-UUID-DRIVER.EXTENSION in
/// $XDG_CACHE_HOME/exemplar or ~/.cache/exemplar. Empty if neither XDG_CACHE_HOME nor HOME is set.
std::filesystem::path device_cache_path(const DeviceInfo& info, std::string_view stem, std::string_view extension);

}  // namespace exemplar
