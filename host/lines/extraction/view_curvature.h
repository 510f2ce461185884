#pragma once

#include <array>

#include "host/mesh/mesh.h"

namespace exemplar {

/// The unit vector w to the eye, in the principal frame of a vertex.
struct ViewVector {
    float u, v;    ///< along e1 and e2
    float cosine;  ///< along the normal
};

/// Returns the derivative of radial curvature along the projection of w, times the sine of the angle between w and
/// the normal. DeCarlo et al. 2004 have C(w, w, w) + 2 K cot where the radial curvature is zero; there K is minus
/// the squared torsion.
float radial_derivative(float k1, float k2, const std::array<float, 4>& derivative, const ViewVector& view);

/// View-dependent curvature (Judd et al. 2007): the change of the normal per unit step on the screen.
struct ViewCurvature {
    float q = 0;                     ///< the maximum, squared; in 1 / squared mesh units
    float least = 0;                 ///< the minimum, likewise
    Vec2 direction = Vec2::UnitX();  ///< of the maximum, in (e1, e2); has length 1 on the screen
    float cosine = 1;                ///< n.w
};

/// Computes view-dependent curvature. With S = diag(k1, k2) and a the unit projection of w into the surface, a step
/// x on the screen is the step x + (1 / |n.w| - 1) a a^T x on the surface, so Q = S + (1 / |n.w| - 1) S a a^T maps
/// it to the change of the normal. q is the largest eigenvalue of Q^T Q; direction is its eigenvector as a step on
/// the surface.
ViewCurvature view_curvature(float k1, float k2, const ViewVector& view);

}  // namespace exemplar
