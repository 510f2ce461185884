#pragma once

#include <cstddef>

#include "host/mesh/mesh.h"

namespace exemplar {

/// Keeps one of the faces that lie on each other, as in sheets that were modeled from both sides; the others are
/// removed. These lie on each other:
/// - faces with the same three vertices, in any order; the first is kept;
/// - two pairs of faces that cut the same quad along its two diagonals, if neither pair bends by more than 20 degrees;
///   the pair with the first face is kept.
/// Vertices at one place must be one (see welded). Returns the number of removed faces. In O(F log F).
std::size_t merge_coincident_faces(TriangleMesh& mesh);

}  // namespace exemplar
