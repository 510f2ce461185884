#pragma once

#include <Eigen/SparseCore>

#include "host/mesh/mesh.h"

namespace exemplar {

/// The Laplace operator of a mesh: (L u)_v / area_v approximates minus the Laplacian of u at vertex v.
struct SurfaceLaplacian {
    Eigen::SparseMatrix<double> matrix;  ///< cotangent weights, clamped to be positive; symmetric, positive
                                         ///< semi-definite
    Eigen::VectorXd area;                ///< each vertex's share of the surface, > 0
};
SurfaceLaplacian surface_laplacian(const TriangleMesh& mesh);

/// Diffuses functions on the surface (columns, one row per vertex) by heat flow over about `distance`. Throws
/// MeshError if that cannot be computed.
Eigen::MatrixXd diffuse(const SurfaceLaplacian& laplacian, double distance, const Eigen::MatrixXd& functions);

/// Smooths a closed surface so that its curvature is continuous, also where implicit solids join with common
/// tangents only. Takes one implicit step of bi-Laplacian flow, which halves waves of length `width`, damps shorter
/// ones more and hardly changes longer ones. Throws MeshError if that cannot be computed.
void fair(TriangleMesh& mesh, double width);

}  // namespace exemplar
