#pragma once

#include <filesystem>
#include <string_view>

#include "gpu/runtime/device/device_info.h"

namespace exemplar {

/// Where something is kept that belongs to a device and its driver's version: FOLDER/STEM-UUID-DRIVER.EXTENSION in
/// $XDG_CACHE_HOME/exemplar or ~/.cache/exemplar; empty if neither variable nor HOME is set.
std::filesystem::path device_cache_path(const DeviceInfo& info, std::string_view stem, std::string_view extension);

}  // namespace exemplar
