#pragma once

#include <cstddef>

#include "host/mesh/mesh.h"
#include "host/synth/modeling/field.h"

namespace exemplar {

/// Polygonizes with cells of at most `detail`, fine enough that coarsening to `faces` removes every trace of the
/// grid.
TriangleMesh fine_mesh(const ImplicitField& field, float detail, std::size_t faces);

/// Returns the number of handles of a closed mesh of one component.
int genus_of(const TriangleMesh& mesh);
bool is_one_component(const TriangleMesh& mesh);

/// Meshes the field's surface with about this many vertices and even triangles: closed, manifold, oriented outward.
TriangleMesh mesh_surface(const ImplicitField& field, float detail, std::size_t vertices);

}  // namespace exemplar
