#pragma once

#include <cstdint>
#include <vector>

#include "host/mesh/mesh.h"
#include "host/synth/modeling/field.h"

namespace exemplar {

/// The part of each face: that of the primitive nearest to its center, with boundaries smoothed by majority and specks
/// (components small against the largest of the same part) given to the neighboring part they border most.
std::vector<std::int32_t> label_faces(const TriangleMesh& mesh, const ImplicitField& field);

}  // namespace exemplar
