#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "host/parts/splitting/part_names.h"
#include "host/parts/splitting/split_mesh.h"

namespace exemplar {

/// The formats of files with parts: obj, ply, stl (a file per part), glb (a node per part).
std::span<const std::string_view> part_formats();

/// Writes the parts in one of part_formats(): STEM_PART.obj, .ply or .stl for each part, or STEM.glb. In file names,
/// characters of part names other than letters, digits, '-', '.' and '_' become '_'. Returns the files. Throws
/// UsageError for another format, DataError if a file cannot be written.
std::vector<std::filesystem::path> write_parts(const std::filesystem::path& stem, const std::string& format,
                                               const MeshParts& names, std::span<const PartMesh> parts);

/// Writes binary glTF (.glb) with a node, a mesh and a colored material per part, named after it.
void write_parts_gltf(const std::filesystem::path& path, const MeshParts& names, std::span<const PartMesh> parts);

}  // namespace exemplar
