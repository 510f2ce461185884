#pragma once

#include <cstdint>
#include <filesystem>

namespace exemplar {

/// Returns the maximum size of a cache folder in bytes: $EXEMPLAR_CACHE_GB times 10^9, or 20 * 10^9 if that is not
/// set. 0 means that nothing is cached. Throws UsageError if it is not a number from 0 to 10^9.
std::uint64_t cache_bound();

/// Removes the least recently used entries of a folder that holds more than `max_bytes` until 90 % of that are
/// left, but never `newest`. An entry was last used when its file last changed. Also removes temporary files of
/// writers that ended in the middle, once they are a day old. Removes only files directly in the folder whose names
/// begin with a hash, as those of entries do. Others may read, write and trim the folder meanwhile; what cannot be
/// removed stays.
void trim_cache(const std::filesystem::path& folder, std::uint64_t max_bytes, const std::filesystem::path& newest);

}  // namespace exemplar
