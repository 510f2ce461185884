#pragma once

#include <cstddef>

#include "host/mesh/mesh.h"
#include "host/synth/modeling/field.h"

namespace exemplar {

/// Polygonizes with a cell of at most `detail`, and finely enough that coarsening to `faces` leaves no trace of the
/// grid.
TriangleMesh fine_mesh(const ImplicitField& field, float detail, std::size_t faces);

/// Handles of a closed mesh of one component.
int genus_of(const TriangleMesh& mesh);
bool is_one_component(const TriangleMesh& mesh);

/// The field's surface in about this many vertices, of even triangles: closed, manifold, oriented outward.
TriangleMesh mesh_surface(const ImplicitField& field, float detail, std::size_t vertices);

}  // namespace exemplar
