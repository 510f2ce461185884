#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include "host/data/cache_bound.h"
#include "host/data/safetensors.h"
#include "host/mesh/mesh.h"

namespace exemplar {

// A cache on disk for results of long computations on meshes. An entry is a file of arrays whose name begins with a
// hash of its input (content_hash). A checksum guards its content. A folder has a size limit; the least recently
// used entries are removed first. Any number of programs may share one folder.

/// Returns the default folder for results of a kind: $XDG_CACHE_HOME/exemplar/KIND, else ~/.cache/exemplar/KIND,
/// else empty.
std::filesystem::path default_cache_folder(std::string_view kind);

/// Returns 32 hexadecimal digits that identify a mesh's content (vertices and faces).
std::string content_hash(const TriangleMesh& mesh);

/// Calls parse(file) with the entry at `path`. Returns false if there is none, if it is damaged, truncated or of
/// another version, or if `parse` rejects it (throws ModelError or an exception of the JSON library); whatever was
/// parsed must then be computed anew. Reading an entry counts as its last use.
bool read_cache_entry(const std::filesystem::path& path, int version,
                      const std::function<void(const TensorFile&)>& parse);

/// Writes an entry, or replaces it, in one step. Does nothing if it cannot be written (a read-only folder or a full
/// disk must not cost the result) or has more than `max_bytes`. The file name of `path` begins with a content_hash
/// and '-', and ends in ".safetensors".
///
/// Sometimes trims the folder to `max_bytes` (see trim_cache), which takes time: after an entry of at least a
/// hundredth of that, and after one in 16 others, chosen by name. Trimming leaves 90 %; on average 16 smaller
/// entries (less than 16 %) come before the next trim, however many programs write.
void write_cache_entry(const std::filesystem::path& path, int version, TensorFile file,
                       std::uint64_t max_bytes = cache_bound());

}  // namespace exemplar
