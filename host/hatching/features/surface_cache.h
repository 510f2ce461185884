#pragma once

#include <filesystem>

#include "host/hatching/features/hatching_surface.h"

namespace exemplar {

/// Returns measure_surface(mesh) from a cache in `folder`, measuring it if need be. Entries are named by a hash of
/// the mesh and k_surface_version, and restore the result bit by bit, times included; damaged, truncated or outdated
/// ones are replaced. An entry takes about a third of a byte per pair of a face and one of the 1000 samples, and a
/// kilobyte per vertex: 17 MB at 20,000 faces, 83 MB at 100,000. An empty or unwritable folder turns the cache off.
/// Throws what measure_surface throws.
HatchingSurface cached_surface(const TriangleMesh& mesh, const std::filesystem::path& folder);

/// Returns the default folder, see default_cache_folder.
std::filesystem::path default_surface_folder();

}  // namespace exemplar
