#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cmath>

#include "host/mesh/mesh.h"

namespace exemplar {

/// The second fundamental form in some tangent frame: (II11, II12, II22).
using Form = std::array<float, 3>;
/// Its derivative: (C111, C112, C122, C222).
using FormDerivative = std::array<float, 4>;

/// A rotation in the tangent plane.
struct TangentRotation {
    float cosine = 1, sine = 0;
    TangentRotation inverse() const { return {cosine, -sine}; }
};

/// Returns `form` in the frame that is rotated by `turn` from its own.
inline Form in_rotated_frame(const Form& form, TangentRotation turn) {
    const float cc = turn.cosine * turn.cosine, cs = turn.cosine * turn.sine, ss = turn.sine * turn.sine;
    return {cc * form[0] + 2 * cs * form[1] + ss * form[2], cs * (form[2] - form[0]) + (cc - ss) * form[1],
            ss * form[0] - 2 * cs * form[1] + cc * form[2]};
}

inline FormDerivative in_rotated_frame(const FormDerivative& d, TangentRotation turn) {
    const float c = turn.cosine, s = turn.sine;
    const float ccc = c * c * c, ccs = c * c * s, css = c * s * s, sss = s * s * s;
    return {ccc * d[0] + 3 * ccs * d[1] + 3 * css * d[2] + sss * d[3],
            -ccs * d[0] + (ccc - 2 * css) * d[1] + (2 * ccs - sss) * d[2] + css * d[3],
            css * d[0] + (sss - 2 * ccs) * d[1] + (ccc - 2 * css) * d[2] + ccs * d[3],
            -sss * d[0] + 3 * css * d[1] - 3 * ccs * d[2] + ccc * d[3]};
}

/// An orthonormal frame of a tangent plane; the third axis is tangent x bitangent.
struct TangentFrame {
    Vec3 tangent = Vec3::UnitX(), bitangent = Vec3::UnitY(), normal = Vec3::UnitZ();
};

/// Returns the rotation from `frame` to the frame with this first axis and normal, once the smallest rotation
/// between their normals has brought that one into the plane of `frame`.
inline TangentRotation rotation_to(const TangentFrame& frame, const Vec3& axis, const Vec3& normal) {
    const float x = frame.tangent.dot(normal), y = frame.bitangent.dot(normal);
    const float one_plus = 1 + frame.normal.dot(normal);
    // The smallest rotation is not unique for opposite normals; their common plane is used as it is.
    const float tilt = one_plus > 1e-6f ? frame.normal.dot(axis) / one_plus : 0.0f;
    return {frame.tangent.dot(axis) - x * tilt, frame.bitangent.dot(axis) - y * tilt};
}

/// Returns a frame with the unit normal n, without branches except for a sign (Duff et al. 2017).
inline TangentFrame frame_of_normal(const Vec3& n) {
    const float sign = std::copysign(1.0f, n.z());
    const float a = -1.0f / (sign + n.z()), b = n.x() * n.y() * a;
    return {{1 + sign * n.x() * n.x() * a, sign * b, -sign * n.x()}, {b, sign + n.y() * n.y() * a, -n.y()}, n};
}

/// Returns the rotation to the principal frame, in which `form` is diagonal with the values k1 >= k2.
inline TangentRotation principal_rotation(const Form& form, float& k1, float& k2) {
    const float half_difference = 0.5f * (form[0] - form[2]), mean = 0.5f * (form[0] + form[2]);
    const float radius = std::hypot(half_difference, form[1]);
    k1 = mean + radius;
    k2 = mean - radius;
    if (!(radius > 0)) return {};
    // Half the angle of (half_difference, form[1]), by the formula of the two that does not cancel.
    if (half_difference >= 0) {
        const float cosine = std::sqrt(0.5f * (1 + half_difference / radius));
        return {cosine, form[1] / (2 * radius * cosine)};
    }
    const float sine = std::sqrt(0.5f * (1 - half_difference / radius));
    return {form[1] / (2 * radius * sine), sine};
}

}  // namespace exemplar
