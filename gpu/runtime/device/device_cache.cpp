#include "gpu/runtime/device/device_cache.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdlib>

namespace exemplar {

std::filesystem::path device_cache_path(const DeviceInfo& info, std::string_view stem, std::string_view extension) {
    std::filesystem::path folder;
    if (const char* cache = std::getenv("XDG_CACHE_HOME"); cache && *cache)
        folder = cache;
    else if (const char* home = std::getenv("HOME"); home && *home)
        folder = std::filesystem::path(home) / ".cache";
    else
        return {};
    return folder / "exemplar" /
           fmt::format("{}-{:02x}-{:08x}.{}", stem, fmt::join(info.cache_uuid, ""), info.driver_number, extension);
}

}  // namespace exemplar
