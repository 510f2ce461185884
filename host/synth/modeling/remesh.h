#pragma once

#include <cstddef>

#include "host/mesh/mesh.h"
#include "host/synth/modeling/field.h"

namespace exemplar {

/// Coarsens a closed manifold mesh of the field's surface to `faces` triangles (an odd count loses one; fewer are left
/// only where the mesh starts with fewer, more where coarsening would break it) and evens out their shapes: collapses
/// of the shortest edges, flips that widen the smallest angle, and tangential smoothing on the surface. Triangles are
/// smaller where the surface bends. Manifoldness, orientation and components are kept.
TriangleMesh remesh(const TriangleMesh& mesh, const ImplicitField& field, std::size_t faces);

}  // namespace exemplar
