#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "host/mesh/mesh.h"

namespace exemplar {

/// Principal curvatures and directions per vertex; k1 >= k2 by sign (thesis Sec. 5.3.1), positive where convex
/// (a sphere of radius r with outward normals has 1/r), in 1 / mesh units.
struct VertexCurvature {
    std::vector<float> k1, k2;
    std::vector<Vec3> e1, e2;  ///< unit, orthogonal to the vertex normal; e1 x e2 = normal
    /// Third-order: the four distinct components of the derivative tensor C in (e1, e2):
    /// C111 = dk1/de1, C112, C122, C222 = dk2/de2, in 1 / squared mesh units. Empty unless asked for.
    std::vector<std::array<float, 4>> derivative;
};
/// Estimates curvature after Rusinkiewicz 2004 ("Estimating Curvatures and Their Derivatives on Triangle Meshes"):
/// fits a tensor per face to the vertex normals by least squares, and averages the tensors at each vertex, weighted
/// by Voronoi areas. Leaves out degenerate faces (lower than 1e-7 of their longest edge).
VertexCurvature estimate_curvature(const TriangleMesh& mesh, bool with_derivatives);

}  // namespace exemplar
