#pragma once

#include <cstddef>

#include "host/mesh/mesh.h"
#include "host/synth/modeling/field.h"

namespace exemplar {

/// Coarsens a closed manifold mesh of the field's surface to `faces` triangles and improves their shapes: collapses
/// the shortest edges, flips edges to increase the smallest angle, and smooths tangentially on the surface.
/// Triangles are smaller where the surface bends. An odd count loses one; there are fewer faces if the mesh starts
/// with fewer, and more if coarsening would break it. Keeps manifoldness, orientation and components.
TriangleMesh remesh(const TriangleMesh& mesh, const ImplicitField& field, std::size_t faces);

}  // namespace exemplar
