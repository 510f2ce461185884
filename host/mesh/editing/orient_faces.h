#pragma once

#include <cstddef>

#include "host/mesh/mesh.h"

namespace exemplar {

/// The numbers of pieces and faces that orient_faces turned around. A piece is a set of faces that are connected across
/// edges of exactly two faces.
struct OrientationChange {
    std::size_t pieces = 0;         ///< of the surface
    std::size_t turned_pieces = 0;  ///< that faced inward
    std::size_t turned_faces = 0;   ///< that disagreed with the rest of their piece
};

/// Turns faces around (swaps their last two corners) so that each piece of the surface is oriented consistently and
/// faces outward. In O(F log F).
/// 1. Within a piece, the orientation of most of its area is kept. A piece that has no consistent orientation (a
///    Moebius strip) is changed only where that leaves fewer edges between faces of opposite orientation.
/// 2. A closed piece faces outward if its signed volume is positive. A piece with holes is judged only if its signed
///    volume about its area centroid exceeds what its holes could hold; others stay as they are.
/// 3. Cavities stay cavities: a closed piece within another that need not be turned keeps facing against it. If the
///    outer piece is turned (a room that was modeled from inside), the pieces within face outward, too.
OrientationChange orient_faces(TriangleMesh& mesh);

}  // namespace exemplar
