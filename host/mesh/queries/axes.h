#pragma once

#include <array>
#include <vector>

#include "host/mesh/mesh.h"

namespace exemplar {

/// Center and principal axes of the surface, taken as a thin shell.
struct PrincipalAxes {
    Vec3 center;                 ///< area centroid
    std::array<Vec3, 3> axis;    ///< orthonormal, by decreasing variance; the surface's third moment along each is
                                 ///< positive (where it is zero the sign is arbitrary)
    std::array<float, 3> sigma;  ///< standard deviation along each axis, in mesh units
};
/// Computes the area-weighted principal axes of the surface (exact integral over each triangle).
PrincipalAxes principal_axes(const TriangleMesh& mesh);

/// A plane of approximate mirror symmetry.
struct SymmetryPlane {
    Vec3 point;
    Vec3 normal;  ///< unit
    float error;  ///< mean distance of mirrored surface samples to the surface, over the bounding-box diagonal
};
/// Returns the `count` best mirror planes through the area centroid, more than 20 degrees apart, by increasing
/// error. The principal planes fill up the list where nothing better is found. Deterministic; depends on the face
/// order only through rounding. Used by thesis App. A.1i.
std::vector<SymmetryPlane> symmetry_planes(const TriangleMesh& mesh, int count = 3);

}  // namespace exemplar
