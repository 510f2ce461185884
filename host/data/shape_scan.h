#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include "host/data/catalog.h"

namespace exemplar {

/// A mesh file, and the path that its results are named after.
struct FoundShape {
    std::filesystem::path path;      ///< absolute
    std::filesystem::path relative;  ///< to the folder that was searched
};

/// Calls `found` for every mesh file in a folder and below it, in natural order. Links are followed to files of the
/// same folder only, and hidden files and folders are left out: what a folder holds decides about nothing outside.
/// `left_out` hears of each link that leads elsewhere. Throws DataError for a folder that cannot be read.
void find_shapes(const std::filesystem::path& folder, const std::function<void(const FoundShape&)>& found,
                 const std::function<void(const std::filesystem::path&)>& left_out);

/// The content hash of a file: XXH3-128, 32 hexadecimal digits. Throws DataError if it cannot be read.
std::string file_hash(const std::filesystem::path& path);

/// Memory that reading a mesh file of so many bytes may take.
std::size_t reading_memory(std::uint64_t file_bytes);

/// Size and time of a file, as a catalog keeps them; path and name are left to the caller. Throws DataError.
CatalogShape stat_shape(const std::filesystem::path& path);
/// Reads a mesh file and says all that a catalog keeps of it. What makes it unusable is its `problem`: unreadable,
/// malformed, not finite, or of more bytes than can be read in `most_memory`. Throws Interrupted only.
CatalogShape describe_shape(const std::filesystem::path& path, std::size_t most_memory);

}  // namespace exemplar
