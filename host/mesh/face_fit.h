#pragma once

#include <array>

#include "host/mesh/mesh.h"
#include "host/mesh/tangent_tensors.h"

namespace exemplar {

/// What the least-squares fits of a face need. Edge i runs from corner i + 1 to corner i + 2; (u, v) are its
/// coordinates in the face's own frame.
struct FaceFit {
    std::array<float, 3> u, v;
    TangentFrame frame;
    std::array<Turn, 3> turn;  ///< from the face's frame to that of corner i, laid flat by the least rotation
    bool valid = false;        ///< false for a degenerate face (lower than 1e-7 of its longest edge)
};

/// What a face gives to the vertex at one of its corners.
struct CornerShare {
    Vec3d normal = Vec3d::Zero();  ///< weighted as in Max 1999
    float area = 0;                ///< of the part of the face nearest to the corner; zero in a degenerate face
};

/// Fills in edges, frame and validity of a face (not the turns); returns the shares of its corners.
std::array<CornerShare, 3> measure_face(const std::array<Vec3, 3>& corners, FaceFit& fit);

/// Least-squares second fundamental form of a face from the change of the vertex normals along its edges
/// (Rusinkiewicz 2004, Sec. 2).
Form fit_form(const FaceFit& fit, const std::array<Vec3, 3>& normals);

/// The same for the derivative, from the change of the vertex forms, given in the face's frame (ibid., Sec. 3).
FormDerivative fit_derivative(const FaceFit& fit, const std::array<Form, 3>& forms);

}  // namespace exemplar
