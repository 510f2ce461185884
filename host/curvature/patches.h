#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "host/mesh/mesh.h"

namespace exemplar {

/// Cuts a surface into connected patches of about `vertices` vertices each, compact and of like size: the vertices
/// nearest, over edges, to seeds that are far from each other. 0 makes the whole surface one patch. Returns the patch
/// of each vertex, numbered from 0; vertices without edges join a patch of their own or, without seeds left, the first.
std::vector<std::uint32_t> surface_patches(const TriangleMesh& mesh, std::size_t vertices);

}  // namespace exemplar
