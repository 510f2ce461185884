#include "host/synth/modeling/primitives.h"

#include <algorithm>
#include <cmath>

namespace exemplar {
namespace {

/// Returns the distance in the half plane (x >= 0 across, y along) to the profile of a round cone from (0, 0) to (0,
/// length).
float round_cone_profile(float x, float y, float length, float r1, float r2) {
    if (std::abs(r1 - r2) >= length) {  // one sphere contains the other
        return r1 > r2 ? std::hypot(x, y) - r1 : std::hypot(x, y - length) - r2;
    }
    const float sine = (r1 - r2) / length, cosine = std::sqrt(1 - sine * sine);
    const float along = y * cosine - x * sine;  // position along the straight side
    if (along < 0) return std::hypot(x, y) - r1;
    if (along > length * cosine) return std::hypot(x, y - length) - r2;
    return x * cosine + y * sine - r1;
}

float box_distance(const Vec3& q) {
    return q.cwiseMax(0.0f).norm() + std::min(q.maxCoeff(), 0.0f);
}

float box_distance(const Vec2& q) {
    return q.cwiseMax(0.0f).norm() + std::min(q.maxCoeff(), 0.0f);
}

/// Returns the signed distance to a polygon: to its nearest edge, with the sign from the crossings of a ray.
float polygon_distance(const std::vector<Vec2>& outline, const Vec2& p) {
    float squared = (p - outline[0]).squaredNorm();
    bool inside = false;
    for (std::size_t i = 0, j = outline.size() - 1; i < outline.size(); j = i++) {
        const Vec2 edge = outline[j] - outline[i], w = p - outline[i];
        const float t = std::clamp(w.dot(edge) / edge.squaredNorm(), 0.0f, 1.0f);
        squared = std::min(squared, (w - t * edge).squaredNorm());
        const bool spans = (outline[i].y() > p.y()) != (outline[j].y() > p.y());
        if (spans && w.x() < edge.x() * w.y() / edge.y()) inside = !inside;
    }
    return inside ? -std::sqrt(squared) : std::sqrt(squared);
}

float distance(const RoundCone& s, const Vec3& p) {
    return round_cone_profile(std::hypot(p.x(), p.z()), p.y(), s.length, s.radius_begin, s.radius_end);
}

float distance(const Ellipsoid& s, const Vec3& p) {
    const Vec3 q = p.cwiseQuotient(s.radius);
    const float k0 = q.norm(), k1 = q.cwiseQuotient(s.radius).norm();
    return k1 < 1e-6f ? -s.radius.minCoeff() : k0 * (k0 - 1) / k1;
}

float distance(const RoundBox& s, const Vec3& p) {
    return box_distance(Vec3(p.cwiseAbs() - s.half + Vec3::Constant(s.rounding))) - s.rounding;
}

float distance(const RoundCylinder& s, const Vec3& p) {
    const Vec2 q(std::hypot(p.x(), p.z()) - s.radius, std::abs(p.y()) - s.half_height);
    return box_distance(Vec2(q + Vec2::Constant(s.rounding))) - s.rounding;
}

float distance(const Torus& s, const Vec3& p) {
    return std::hypot(std::hypot(p.x(), p.z()) - s.major, p.y()) - s.minor;
}

float distance(const Prism& s, const Vec3& p) {
    const float across = polygon_distance(s.outline, Vec2(p.x(), p.z()));
    return box_distance(Vec2(across, std::abs(p.y()) - s.half_height)) - s.rounding;
}

float distance(const Lathe& s, const Vec3& p) {
    const Vec2 q(std::hypot(p.x(), p.z()), p.y());
    float nearest = (q - s.profile[0]).norm() - s.thickness[0];
    for (std::size_t i = 1; i < s.profile.size(); ++i) {
        const Vec2 edge = s.profile[i] - s.profile[i - 1], w = q - s.profile[i - 1];
        const float length = edge.norm(), y = w.dot(edge) / length;
        const float x = std::abs(w.x() * edge.y() - w.y() * edge.x()) / length;
        nearest = std::min(nearest, round_cone_profile(x, y, length, s.thickness[i - 1], s.thickness[i]));
    }
    return nearest;
}

float distance(const Tube& s, const Vec3& p) {
    float nearest = (p - s.points[0]).norm() - s.radii[0];
    for (std::size_t i = 1; i < s.points.size(); ++i) {
        const Vec3 edge = s.points[i] - s.points[i - 1], w = p - s.points[i - 1];
        const float t = std::clamp(w.dot(edge) / edge.squaredNorm(), 0.0f, 1.0f);
        nearest = std::min(nearest, (w - t * edge).norm() - (s.radii[i - 1] + t * (s.radii[i] - s.radii[i - 1])));
    }
    return nearest;
}

Ball ball(const RoundCone& s) {
    const float low = -s.radius_begin, high = s.length + s.radius_end;
    const float radius = std::max({(high - low) / 2, s.radius_begin, s.radius_end});
    return {Vec3(0, (low + high) / 2, 0), radius};
}

Ball ball(const Ellipsoid& s) {
    return {Vec3::Zero(), s.radius.maxCoeff()};
}

Ball ball(const RoundBox& s) {
    return {Vec3::Zero(), s.half.norm()};
}

Ball ball(const RoundCylinder& s) {
    return {Vec3::Zero(), std::hypot(s.half_height, s.radius)};
}

Ball ball(const Torus& s) {
    return {Vec3::Zero(), s.major + s.minor};
}

Ball ball(const Prism& s) {
    float reach = 0;
    for (const Vec2& p : s.outline) reach = std::max(reach, p.norm());
    return {Vec3::Zero(), std::hypot(reach, s.half_height) + s.rounding};
}

Ball ball(const Lathe& s) {
    float low = s.profile[0].y(), high = low, radius = 0;
    for (const Vec2& p : s.profile) {
        low = std::min(low, p.y());
        high = std::max(high, p.y());
    }
    const float middle = (low + high) / 2;
    for (std::size_t i = 0; i < s.profile.size(); ++i)
        radius = std::max(radius, (s.profile[i] - Vec2(0, middle)).norm() + s.thickness[i]);
    return {Vec3(0, middle, 0), radius};
}

Ball ball(const Tube& s) {
    Vec3 low = s.points[0], high = low;
    for (const Vec3& p : s.points) {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
    }
    Ball result{(low + high) / 2, 0};
    for (std::size_t i = 0; i < s.points.size(); ++i)
        result.radius = std::max(result.radius, (s.points[i] - result.center).norm() + s.radii[i]);
    return result;
}

}  // namespace

float solid_distance(const Solid& solid, const Vec3& p) {
    return std::visit([&](const auto& s) { return distance(s, p); }, solid);
}

Ball bounding_ball(const Solid& solid) {
    return std::visit([](const auto& s) { return ball(s); }, solid);
}

std::vector<Ball> covering_balls(const Solid& solid) {
    const Tube* tube = std::get_if<Tube>(&solid);
    if (!tube) return {bounding_ball(solid)};
    std::vector<Ball> balls;
    for (std::size_t i = 0; i < tube->points.size(); ++i) balls.push_back({tube->points[i], tube->radii[i]});
    return balls;
}

}  // namespace exemplar
