#pragma once

#include <array>

#include "host/mesh/mesh.h"

namespace exemplar {

/// The unit vector to the eye in the frame of a vertex.
struct ViewVector {
    float u, v;    ///< along e1 and e2
    float cosine;  ///< along the normal
};

/// Derivative of radial curvature along w's projection, times the sine between w and the normal: DeCarlo et al. 2004
/// have C(w, w, w) + 2 K cot, where the radial curvature is zero, and there K is the negative square of the torsion.
float radial_derivative(float k1, float k2, const std::array<float, 4>& derivative, const ViewVector& view);

/// View-dependent curvature (Judd et al. 2007): how much the normal turns over a step on the screen.
struct ViewCurvature {
    float q = 0;                     ///< the largest: squared, in 1 / squared mesh units
    float least = 0;                 ///< the smallest, likewise
    Vec2 direction = Vec2::UnitX();  ///< of it, on the surface, in (e1, e2); a step of length 1 on the screen
    float cosine = 1;                ///< n.w
};

/// With S = diag(k1, k2) and a the unit projection of w into the surface, a step x on the screen is one of
/// x + (1 / |n.w| - 1) a a^T x on the surface, so Q = S + (1 / |n.w| - 1) S a a^T turns it into the change of the
/// normal. The largest eigenvalue of Q^T Q, and its eigenvector.
ViewCurvature view_curvature(float k1, float k2, const ViewVector& view);

}  // namespace exemplar
