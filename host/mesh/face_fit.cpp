#include "host/mesh/face_fit.h"

#include <algorithm>
#include <cmath>

namespace exemplar {

namespace {

/// Solves the symmetric tridiagonal positive definite system with this diagonal and off-diagonal.
template <std::size_t N>
std::array<float, N> solve_tridiagonal(std::array<double, N> diagonal, const std::array<double, N - 1>& off,
                                       std::array<double, N> right) {
    for (std::size_t i = 1; i < N; ++i) {
        const double factor = off[i - 1] / diagonal[i - 1];
        diagonal[i] -= factor * off[i - 1];
        right[i] -= factor * right[i - 1];
    }
    std::array<float, N> solution;
    double next = 0;
    for (std::size_t i = N; i-- > 0;) {
        if (i + 1 < N) right[i] -= off[i] * next;
        next = right[i] / diagonal[i];
        solution[i] = static_cast<float>(next);
    }
    return solution;
}

/// The part of a triangle that is nearest to each corner (Meyer et al. 2003), from its squared edge lengths; where an
/// angle is obtuse the Voronoi cells are cut off at the opposite edge.
std::array<double, 3> voronoi_areas(const std::array<double, 3>& squared_length, double area) {
    const auto& l = squared_length;
    std::array<double, 3> result;
    const double sum = l[0] + l[1] + l[2];
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
        if (2 * l[i] >= sum) {
            // Beside an obtuse angle at corner i a corner keeps a right triangle over half its edge to i:
            // an eighth of that edge's squared length times the tangent of its own angle.
            result[j] = l[k] * area / (2 * (sum - 2 * l[j]));
            result[k] = l[j] * area / (2 * (sum - 2 * l[k]));
            result[i] = area - result[j] - result[k];
            return result;
        }
    }
    const double scale = 1 / (32 * area);
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
        result[i] = (l[j] * (sum - 2 * l[j]) + l[k] * (sum - 2 * l[k])) * scale;
    }
    return result;
}

}  // namespace

std::array<CornerShare, 3> measure_face(const std::array<Vec3, 3>& corners, FaceFit& fit) {
    // In double: the products of float coordinates then neither cancel nor underflow.
    const Vec3d p0 = corners[0].cast<double>(), p1 = corners[1].cast<double>(), p2 = corners[2].cast<double>();
    const Vec3d e0 = p2 - p1, e1 = p0 - p2, e2 = p1 - p0;
    const Vec3d n = e0.cross(e1);
    const std::array<double, 3> squared = {e0.squaredNorm(), e1.squaredNorm(), e2.squaredNorm()};
    const double longest = std::max({squared[0], squared[1], squared[2]});
    const double twice_area = n.norm();
    std::array<CornerShare, 3> shares;
    // |n| is sine times the two edge lengths, so the squared lengths leave sine over lengths. Between edges of which
    // one is zero, fused products leave n a little above it.
    if (squared[0] > 0 && squared[1] > 0 && squared[2] > 0)
        for (std::size_t i = 0; i < 3; ++i) shares[i].normal = n / (squared[(i + 1) % 3] * squared[(i + 2) % 3]);
    // Thinner slivers are rounding noise, and the differences of squares in voronoi_areas would vanish.
    fit.valid = twice_area > 1e-7 * longest;
    if (!fit.valid) return shares;

    const std::array<double, 3> areas = voronoi_areas(squared, 0.5 * twice_area);
    for (std::size_t i = 0; i < 3; ++i) shares[i].area = static_cast<float>(areas[i]);
    const double length = std::sqrt(squared[0]), inverse = 1 / length;
    const double along = e0.dot(e1) * inverse, height = twice_area * inverse;
    fit.u = {static_cast<float>(length), static_cast<float>(along), static_cast<float>(-length - along)};
    fit.v = {0.0f, static_cast<float>(height), static_cast<float>(-height)};
    fit.frame.tangent = (e0 * inverse).cast<float>();
    fit.frame.normal = (n / twice_area).cast<float>();
    fit.frame.bitangent = fit.frame.normal.cross(fit.frame.tangent);
    return shares;
}

Form fit_form(const FaceFit& fit, const std::array<Vec3, 3>& normals) {
    double uu = 0, uv = 0, vv = 0;
    std::array<double, 3> right{};
    for (std::size_t i = 0; i < 3; ++i) {
        const double u = fit.u[i], v = fit.v[i];
        const Vec3 change = normals[(i + 2) % 3] - normals[(i + 1) % 3];
        const double du = fit.frame.tangent.dot(change), dv = fit.frame.bitangent.dot(change);
        uu += u * u;
        uv += u * v;
        vv += v * v;
        right[0] += u * du;
        right[1] += v * du + u * dv;
        right[2] += v * dv;
    }
    return solve_tridiagonal<3>({uu, uu + vv, vv}, {uv, uv}, right);
}

FormDerivative fit_derivative(const FaceFit& fit, const std::array<Form, 3>& forms) {
    double uu = 0, uv = 0, vv = 0;
    std::array<double, 4> right{};
    for (std::size_t i = 0; i < 3; ++i) {
        const double u = fit.u[i], v = fit.v[i];
        const Form &to = forms[(i + 2) % 3], &from = forms[(i + 1) % 3];
        const double d11 = to[0] - from[0], d12 = to[1] - from[1], d22 = to[2] - from[2];
        uu += u * u;
        uv += u * v;
        vv += v * v;
        right[0] += u * d11;
        right[1] += v * d11 + 2 * u * d12;
        right[2] += 2 * v * d12 + u * d22;
        right[3] += v * d22;
    }
    return solve_tridiagonal<4>({uu, 2 * uu + vv, uu + 2 * vv, vv}, {uv, 2 * uv, uv}, right);
}

}  // namespace exemplar
