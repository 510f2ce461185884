#pragma once

#include <cstdint>
#include <vector>

#include "host/mesh/mesh.h"
#include "host/synth/modeling/field.h"

namespace exemplar {

/// Returns the part of each face: that of the primitive nearest to its center. Boundaries are smoothed by majority,
/// and specks (components that are small compared with the largest of the same part) get the neighboring part with
/// the longest common border.
std::vector<std::int32_t> label_faces(const TriangleMesh& mesh, const ImplicitField& field);

}  // namespace exemplar
