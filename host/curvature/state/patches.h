#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "host/mesh/mesh.h"

namespace exemplar {

/// Cuts a surface into the fewest patches of at most `vertices` vertices each, compact and nearly all of them full: in
/// halves along its length, as it is measured over edges, and the halves in halves. Patches that follow each other
/// mostly lie near each other. A patch has vertices of several pieces of the surface only where it would not be full
/// otherwise. 0 makes the whole surface one patch. Returns the patch of each vertex, numbered from 0.
std::vector<std::uint32_t> surface_patches(const TriangleMesh& mesh, std::size_t vertices);

}  // namespace exemplar
