#pragma once

#include <cstddef>

#include "host/mesh/mesh.h"

namespace exemplar {

/// Removes the faces without area, and leaves no gap where they were. Returns the number of removed faces.
/// A face has no area if its height over its longest side is at most rounding: 4 float epsilons (2^-23) times its
/// largest absolute coordinate, and at most 1/1024 of that side. Its third corner then lies on the longest side, and
/// the faces across that side are split there: both halves keep their source face. Halves stand at the place of the
/// whole. If nothing is across, or splitting would put two faces where one is, the face is only left out.
/// A mesh none of whose faces has an area stays as it is.
/// Vertices at one place must be one (see welded), and no face may name a vertex twice. In O(F log F).
std::size_t remove_flat_faces(TriangleMesh& mesh);

}  // namespace exemplar
