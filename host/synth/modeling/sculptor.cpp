#include "host/synth/modeling/sculptor.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

namespace exemplar {
namespace {

Eigen::Matrix3f turn(const Vec3& axis, float degrees) {
    return Eigen::AngleAxisf(degrees * 0.017453293f, axis).toRotationMatrix();
}

}  // namespace

Eigen::Matrix3f turn_x(float degrees) {
    return turn(Vec3::UnitX(), degrees);
}

Eigen::Matrix3f turn_y(float degrees) {
    return turn(Vec3::UnitY(), degrees);
}

Eigen::Matrix3f turn_z(float degrees) {
    return turn(Vec3::UnitZ(), degrees);
}

Eigen::Matrix3f axes_along(const Vec3& direction, const Vec3& side) {
    const Vec3 y = direction.normalized();
    Vec3 x = y.cross(side);
    if (x.norm() < 1e-3f * side.norm()) x = y.cross(std::abs(y.x()) < 0.8f ? Vec3::UnitX() : Vec3::UnitZ());
    x.normalize();
    Eigen::Matrix3f axes;
    axes.col(0) = x;
    axes.col(1) = y;
    axes.col(2) = x.cross(y);
    return axes;
}

float pick(Random& random, float low, float high) {
    return static_cast<float>(random.uniform(low, high));
}

bool chance(Random& random, double probability) {
    return random.uniform() < probability;
}

std::vector<Vec3> smooth_curve(std::span<const Vec3> control, std::size_t count) {
    std::vector<Vec3> points;
    const std::size_t last = control.size() - 1;
    for (std::size_t i = 0; i < count; ++i) {
        const float at = static_cast<float>(i) / static_cast<float>(count - 1) * static_cast<float>(last);
        const std::size_t k = std::min(static_cast<std::size_t>(at), last - 1);
        const float t = at - static_cast<float>(k);
        const Vec3 &p1 = control[k], &p2 = control[k + 1];
        const Vec3 p0 = k > 0 ? control[k - 1] : Vec3(2 * p1 - p2);
        const Vec3 p3 = k + 2 <= last ? control[k + 2] : Vec3(2 * p2 - p1);
        const Vec3 m1 = (p2 - p0) / 2, m2 = (p3 - p1) / 2;  // tangents of the cubic Hermite segment
        const float t2 = t * t, t3 = t2 * t;
        points.push_back((2 * t3 - 3 * t2 + 1) * p1 + (t3 - 2 * t2 + t) * m1 + (3 * t2 - 2 * t3) * p2 + (t3 - t2) * m2);
    }
    return points;
}

std::vector<Vec2> superellipse(float a, float b, float power, std::size_t count) {
    std::vector<Vec2> points;
    for (std::size_t i = 0; i < count; ++i) {
        const float angle = 6.2831853f * static_cast<float>(i) / static_cast<float>(count);
        const float c = std::cos(angle), s = std::sin(angle);
        const float r = std::pow(std::pow(std::abs(c), power) + std::pow(std::abs(s), power), -1 / power);
        points.push_back({a * r * c, b * r * s});
    }
    return points;
}

void Sculptor::add(Solid solid, const Frame& frame, const Vec3& stretch) {
    model_.primitives.push_back({std::move(solid), part_, frame.origin, frame.axes, stretch, blend_});
}

void Sculptor::limb(const Vec3& a, const Vec3& b, float radius_a, float radius_b, float flatten, const Vec3& side) {
    const float length = std::max((b - a).norm(), 1e-4f);
    add(RoundCone{length, radius_a, radius_b}, {a, axes_along(b - a, side)}, Vec3(1, 1, flatten));
}

void Sculptor::tube(std::span<const Vec3> points, std::span<const float> radii, const Vec3& widen) {
    Tube tube{{}, {radii.begin(), radii.end()}};
    for (const Vec3& p : points) tube.points.push_back(p.cwiseQuotient(widen));
    add(std::move(tube), {}, widen);
}

void Sculptor::tube(std::span<const Vec3> points, float first, float last, const Vec3& widen) {
    std::vector<float> radii;
    for (std::size_t i = 0; i < points.size(); ++i)
        radii.push_back(first + (last - first) * static_cast<float>(i) / static_cast<float>(points.size() - 1));
    tube(points, radii, widen);
}

void Sculptor::bar(const Vec3& a, const Vec3& b, float half_width, float half_depth, float rounding, const Vec3& side) {
    const Frame frame{(a + b) / 2, axes_along(b - a, side)};
    box(frame, Vec3(half_width, (b - a).norm() / 2, half_depth), rounding);
}

void Sculptor::rod(const Vec3& a, const Vec3& b, float radius, float rounding) {
    add(RoundCylinder{(b - a).norm() / 2, radius, rounding}, {(a + b) / 2, axes_along(b - a)});
}

}  // namespace exemplar
