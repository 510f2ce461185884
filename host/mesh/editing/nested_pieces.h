#pragma once

#include <cstdint>
#include <vector>

#include "host/mesh/mesh.h"

namespace exemplar {

/// Finds which closed pieces of a surface lie within others. `piece_of_face` has the piece of each face;
/// `volume_sign` has 1 for a closed piece that faces outward, -1 for one that faces inward, and 0 for pieces that
/// take no part. Returns for each piece the innermost other piece that encloses it, k_invalid_index if there is none.
/// Pieces are taken not to cross each other.
std::vector<std::uint32_t> enclosing_pieces(const TriangleMesh& mesh, const std::vector<std::uint32_t>& piece_of_face,
                                            const std::vector<int>& volume_sign);

}  // namespace exemplar
