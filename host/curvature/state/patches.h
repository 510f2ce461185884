#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "host/mesh/mesh.h"

namespace exemplar {

/// Cuts a surface into the minimum number of patches of at most `vertices` vertices each, by recursive halving across
/// its longest extent (measured over edges, except in small parts). Patches are compact, and nearly all are full.
/// Patches with consecutive numbers mostly lie near each other. A patch spans several connected components only where
/// it would not be full otherwise. 0 makes the whole surface one patch. Returns the patch of each vertex, from 0.
std::vector<std::uint32_t> surface_patches(const TriangleMesh& mesh, std::size_t vertices);

}  // namespace exemplar
