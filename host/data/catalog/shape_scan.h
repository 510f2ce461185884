#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include "host/data/catalog/catalog.h"

namespace exemplar {

/// A mesh file, and the path that its results are named after.
struct FoundShape {
    std::filesystem::path path;      ///< absolute
    std::filesystem::path relative;  ///< to the folder that was searched
};

/// Hears of what is not searched, and why.
using LeftOut = std::function<void(const std::filesystem::path& path, const std::string& why)>;

/// Calls `found` for every mesh file in a folder and below it, in natural order. Links are followed to files of the
/// same folder only, and hidden files and folders are left out: what a folder holds decides about nothing outside. So
/// are folders that batch labeling has written to. `left_out` hears of each link that leads elsewhere, and of folders
/// below that cannot be read. Throws DataError if `folder` itself cannot be read, or is one that was written to.
void find_shapes(const std::filesystem::path& folder, const std::function<void(const FoundShape&)>& found,
                 const LeftOut& left_out);

/// The content hash of a file: XXH3-128, 32 hexadecimal digits. Throws DataError if it cannot be read.
std::string file_hash(const std::filesystem::path& path);

/// Memory that reading a mesh file of so many bytes may take.
std::size_t reading_memory(std::uint64_t file_bytes);

/// Bytes that are read of a mesh file and of those that it names (buffers of glTF). Throws MeshError if reading them
/// would take more than `most_memory`, DataError if there is no such file.
std::uint64_t bytes_to_read(const std::filesystem::path& path, std::size_t most_memory);

/// Size and time of a file, as a catalog keeps them; path and name are left to the caller. Throws DataError.
CatalogShape stat_shape(const std::filesystem::path& path);
/// Reads a mesh file and says all that a catalog keeps of it. What makes it unusable is its `problem`: unreadable,
/// malformed, not finite, or of more bytes than can be read in `most_memory`. Throws Interrupted only.
CatalogShape describe_shape(const std::filesystem::path& path, std::size_t most_memory);

}  // namespace exemplar
