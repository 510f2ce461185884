#pragma once

#include "host/mesh/mesh.h"
#include "host/synth/modeling/field.h"

namespace exemplar {

/// Extracts the zero surface of a field by marching tetrahedra on a cubic grid of this cell size (each cube is cut
/// into the six tetrahedra around its main diagonal), and moves the vertices onto the surface. The result is closed,
/// manifold and oriented outward for any field; its triangles still need remeshing. Samples the field only near its
/// surface.
TriangleMesh polygonize(const ImplicitField& field, float cell);

}  // namespace exemplar
