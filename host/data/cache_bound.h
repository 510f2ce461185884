#pragma once

#include <cstdint>
#include <filesystem>

namespace exemplar {

/// How many bytes the entries of one cache folder may take: $EXEMPLAR_CACHE_GB times 10^9, or 20 * 10^9 where that is
/// not set. 0: nothing is to be remembered. Throws UsageError if it is no number from 0 to 10^9.
std::uint64_t cache_bound();

/// If the entries of a folder take more than `most_bytes`, removes those that were not used for longest until 90 % of
/// that are left, but never `newest`; and what writers that ended in the middle have left, once it is a day old. Used
/// was an entry at the time of its last change. Only files directly in the folder that are named as entries are, with
/// a hash first, are ever removed. Others may read, write and trim the folder meanwhile; what cannot be removed stays.
void trim_cache(const std::filesystem::path& folder, std::uint64_t most_bytes, const std::filesystem::path& newest);

}  // namespace exemplar
