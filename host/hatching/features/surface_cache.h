#pragma once

#include <filesystem>

#include "host/hatching/features/hatching_surface.h"

namespace exemplar {

/// measure_surface with a memory on disk: results are kept in `folder` under a hash of the mesh's content and the
/// version of what they mean, and come back bit by bit, times included. An entry that is damaged, truncated or of
/// another version is measured again and replaced. An entry is about a third of a byte for each pair of a face and one
/// of the 1000 samples, and a kilobyte for each vertex: 17 MB at 20,000 faces, 83 MB at 100,000. An empty folder turns
/// the memory off; one that cannot be written is as if empty. Throws what measure_surface throws.
HatchingSurface cached_surface(const TriangleMesh& mesh, const std::filesystem::path& folder);

/// The folder used by default, see default_cache_folder.
std::filesystem::path default_surface_folder();

}  // namespace exemplar
