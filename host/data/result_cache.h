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

// Results of long work on a mesh, remembered on disk: an entry is a file of arrays, named after what it was made from
// (content_hash), and is trusted only whole. A folder of entries keeps within a bound: what was not used for longest
// goes first. Any number of programs may use one folder.

/// The folder used by default for results of a kind: $XDG_CACHE_HOME/exemplar/KIND, else ~/.cache/exemplar/KIND, else
/// empty.
std::filesystem::path default_cache_folder(std::string_view kind);

/// 32 hexadecimal digits that identify a mesh's content (vertices and faces).
std::string content_hash(const TriangleMesh& mesh);

/// Calls parse(file) with the entry at `path`. False if there is none, or one that is damaged, truncated or of another
/// version, or if `parse` finds an array or a text in it that is not as it should be (throws ModelError or an exception
/// of the JSON library): what it has parsed is to be made anew then. An entry that was read counts as used just now.
bool read_cache_entry(const std::filesystem::path& path, int version,
                      const std::function<void(const TensorFile&)>& parse);

/// Writes an entry, or replaces it, in one step. One that cannot be written is left out: a read-only folder or a full
/// disk must not cost the result. So is one of more than `most_bytes`. `path` ends in a name that begins with a
/// content_hash and '-', and ends in ".safetensors".
///
/// Now and then the folder is trimmed to `most_bytes` (see trim_cache): after an entry of at least a hundredth of that,
/// and after one in 16 others, chosen by name, since listing a folder takes time. Trimming leaves 90 %; until the next,
/// however many programs write, come 16 smaller entries in the mean: less than 16 %.
void write_cache_entry(const std::filesystem::path& path, int version, TensorFile file,
                       std::uint64_t most_bytes = cache_bound());

}  // namespace exemplar
