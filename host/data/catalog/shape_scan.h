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

/// Called with each path that is left out, and why.
using SkipHandler = std::function<void(const std::filesystem::path& path, const std::string& why)>;

/// Calls `found` for every mesh file in a folder and below it, in natural order. Follows links only to files of the
/// same folder, and skips hidden files and folders and those that batch labeling has written to: so the content of a
/// folder cannot refer to anything outside. Calls `left_out` for each link that leads elsewhere, and for folders
/// below that cannot be read. Throws DataError if `folder` itself cannot be read, or batch labeling has written to
/// it.
void find_shapes(const std::filesystem::path& folder, const std::function<void(const FoundShape&)>& found,
                 const SkipHandler& left_out);

/// Returns the content hash of a file: XXH3-128, 32 hexadecimal digits. Throws DataError if it cannot be read.
std::string file_hash(const std::filesystem::path& path);

/// Returns the memory that reading a mesh file of so many bytes may take.
std::size_t reading_memory(std::uint64_t file_bytes);

/// Returns the size of a mesh file and of the files that it names (buffers of glTF). Throws MeshError if reading
/// them would take more than `max_memory`, DataError if there is no such file.
std::uint64_t bytes_to_read(const std::filesystem::path& path, std::size_t max_memory);

/// Returns the size and time of a file as a catalog stores them, and its path; the name is left to the caller.
/// Throws DataError.
CatalogShape stat_shape(const std::filesystem::path& path);
/// Reads a mesh file and returns all that a catalog stores of it. `problem` says why it cannot be used: unreadable,
/// malformed, not finite, or more bytes than can be read in `max_memory`. Throws Interrupted only.
CatalogShape describe_shape(const std::filesystem::path& path, std::size_t max_memory);

}  // namespace exemplar
