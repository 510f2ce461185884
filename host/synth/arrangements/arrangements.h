#pragma once

#include <cstddef>
#include <span>
#include <string_view>

#include "host/mesh/mesh.h"

namespace exemplar {

/// A kind of mesh whose faces lie, or are joined, in an unusual way.
struct Arrangement {
    std::string_view name;
    TriangleMesh (*make)(std::size_t faces);  ///< about as many faces, from 100; equal calls give equal meshes
};

/// Returns all kinds: "floor" (a ball on a floor 2,000 times as wide, two faces), "cone" (two vertices that half of the
/// faces share each), "slats" (long thin boxes side by side, across the axes), "spikes" (a ball with a spike at every
/// fourth vertex, of lengths from 0.1 to 100), "graded" (a sheet whose faces shrink a million times towards one
/// corner), "pieces" (loose tetrahedra) and "strip" (a band one face wide).
std::span<const Arrangement> arrangements();

/// Throws UsageError for an unknown name.
const Arrangement& arrangement_named(std::string_view name);

}  // namespace exemplar
