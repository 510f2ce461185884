#pragma once

#include <Eigen/SparseCore>

#include "host/mesh/mesh.h"

namespace exemplar {

/// The Laplace operator of a mesh: (L u)_v / area_v is about minus the Laplacian of u at vertex v.
struct SurfaceLaplacian {
    Eigen::SparseMatrix<double> matrix;  ///< cotangent weights, held positive; symmetric, positive semi-definite
    Eigen::VectorXd area;                ///< each vertex's share of the surface, > 0
};
SurfaceLaplacian surface_laplacian(const TriangleMesh& mesh);

/// What is left of functions on the surface (columns, one row per vertex) after heat has flowed over about `distance`.
/// Throws MeshError if that cannot be computed.
Eigen::MatrixXd diffuse(const SurfaceLaplacian& laplacian, double distance, const Eigen::MatrixXd& functions);

/// Smooths a closed surface so that its curvature varies continuously, as where implicit solids that only share
/// tangents meet: one implicit step of bi-Laplacian flow, which leaves half of waves of length `width`, ever less of
/// shorter ones and almost all of longer ones. Throws MeshError if that cannot be computed.
void fair(TriangleMesh& mesh, double width);

}  // namespace exemplar
