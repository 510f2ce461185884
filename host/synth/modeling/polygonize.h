#pragma once

#include "host/mesh/mesh.h"
#include "host/synth/modeling/field.h"

namespace exemplar {

/// The zero surface of a field by marching tetrahedra on a cubic grid of this cell size (each cube cut into the six
/// tetrahedra around its main diagonal), vertices moved onto the surface. The result is closed, manifold and oriented
/// outward whatever the field; its triangles still need remeshing. The field is sampled only near its surface.
TriangleMesh polygonize(const ImplicitField& field, float cell);

}  // namespace exemplar
