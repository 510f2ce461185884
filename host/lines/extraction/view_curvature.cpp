#include "host/lines/extraction/view_curvature.h"

#include <algorithm>
#include <cmath>

namespace exemplar {

namespace {

constexpr float k_grazing = 1e-3f;  // minimum |n.w| for foreshortening

}  // namespace

float radial_derivative(float k1, float k2, const std::array<float, 4>& derivative, const ViewVector& view) {
    const float u = view.u, v = view.v, squared_sine = u * u + v * v;
    if (!(squared_sine > 0)) return 0;  // w is along the normal, so it has no projection
    const auto& [c111, c112, c122, c222] = derivative;
    const float third = u * u * (u * c111 + 3 * v * c112) + v * v * (3 * u * c122 + v * c222);
    const float torsion = (k2 - k1) * u * v / squared_sine;
    return third / squared_sine - 2 * view.cosine * torsion * torsion;
}

ViewCurvature view_curvature(float k1, float k2, const ViewVector& view) {
    const auto& [u, v, cosine] = view;
    ViewCurvature result;
    result.cosine = cosine;
    const float sine = std::hypot(u, v), step = 1 / std::max(std::abs(cosine), k_grazing), stretch = step - 1;
    const Vec2 a = sine > 0 ? Vec2(u / sine, v / sine) : Vec2::Zero();
    const Eigen::Matrix2f to_surface = Eigen::Matrix2f::Identity() + stretch * a * a.transpose();
    const Eigen::Matrix2f to_normal = Eigen::Vector2f(k1, k2).asDiagonal() * to_surface;
    const Eigen::Matrix2f squared = to_normal.transpose() * to_normal;
    const float half_difference = 0.5f * (squared(0, 0) - squared(1, 1)), off = squared(0, 1);
    const float radius = std::hypot(half_difference, off);
    result.q = 0.5f * squared.trace() + radius;
    // From the determinant of Q, k1 k2 step, since the difference of trace and radius cancels.
    const float determinant = k1 * k2 * step;
    result.least = result.q > 0 ? std::min(determinant / result.q * determinant, result.q) : 0.0f;
    // Half the angle of (half_difference, off).
    const float angle = 0.5f * std::atan2(off, half_difference);
    result.direction = to_surface * Vec2(std::cos(angle), std::sin(angle));
    return result;
}

}  // namespace exemplar
