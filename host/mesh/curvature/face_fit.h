#pragma once

#include <array>

#include "host/mesh/curvature/tangent_tensors.h"
#include "host/mesh/curvature/tensor_equations.h"
#include "host/mesh/mesh.h"

namespace exemplar {

/// Measures of a face for the fits and for the vertices at its corners. Edge i runs from corner i + 1 to corner i +
/// 2.
struct FaceFit {
    std::array<Vec2, 3> edge;  ///< in the face's own frame
    TangentFrame frame;
    std::array<TangentRotation, 3> turn;  ///< from the face's frame to that of corner i, by the smallest rotation (see
                                          ///< rotation_to)
    std::array<float, 3> corner_area;     ///< area of the part of the face nearest to each corner; zero in a degenerate
                                          ///< face
    /// Corner i adds `normal` times `normal_weight[i]` to the vertex normal (Max 1999); zero without area.
    std::array<float, 3> normal_weight;
    Vec3d normal;
    bool valid = false;  ///< false for a degenerate face (lower than 1e-7 of its longest edge)
};

/// Fills in everything except `turn`.
void measure_face(const std::array<Vec3, 3>& corners, FaceFit& fit);

/// Returns the values as floats.
template <std::size_t N>
std::array<float, N> rounded(const std::array<double, N>& values) {
    std::array<float, N> result;
    for (std::size_t i = 0; i < N; ++i) result[i] = static_cast<float>(values[i]);
    return result;
}

/// Fits the second fundamental form of a face, by least squares, to the change of the vertex normals along its edges
/// (Rusinkiewicz 2004, Sec. 2). Inline as the next one, which saves a tenth of the time to estimate curvature.
inline Form fit_form(const FaceFit& fit, const std::array<Vec3, 3>& normals) {
    TensorEquations<3> equations;
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3 change = normals[(i + 2) % 3] - normals[(i + 1) % 3];
        equations.add(fit.edge[i].x(), fit.edge[i].y(),
                      {fit.frame.tangent.dot(change), fit.frame.bitangent.dot(change)});
    }
    return rounded(equations.solve());
}

/// Fits the derivative to the change of the vertex forms, given in the face's frame (ibid., Sec. 3).
inline FormDerivative fit_derivative(const FaceFit& fit, const std::array<Form, 3>& forms) {
    TensorEquations<4> equations;
    for (std::size_t i = 0; i < 3; ++i) {
        const Form &to = forms[(i + 2) % 3], &from = forms[(i + 1) % 3];
        equations.add(fit.edge[i].x(), fit.edge[i].y(), {to[0] - from[0], to[1] - from[1], to[2] - from[2]});
    }
    return rounded(equations.solve());
}

}  // namespace exemplar
