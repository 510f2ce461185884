#include "host/parts/prototype/print_joint.h"

#include <algorithm>
#include <cmath>

namespace exemplar {
namespace {

/// Signed distance to a cylinder with flat ends around `center`.
float cylinder_distance(const Vec3& point, const Vec3& center, const Vec3& axis, float radius, float half_length) {
    const Vec3 p = point - center;
    const float along = std::abs(p.dot(axis)) - half_length;
    const float around = (p - p.dot(axis) * axis).norm() - radius;
    const float outside = std::hypot(std::max(along, 0.0F), std::max(around, 0.0F));
    return outside + std::min(std::max(along, around), 0.0F);
}

}  // namespace

float PrintJoint::head_distance(const Vec3& point, float gap) const {
    if (kind == PrintJointKind::hinge)
        return cylinder_distance(point, center, hinge, radius + gap, 0.9F * radius + gap);
    return (point - center).norm() - radius - gap;
}

float PrintJoint::pin_distance(const Vec3& point) const {
    const float length = (k_ball_depth + 1.2F) * radius;
    return cylinder_distance(point, center - length / 2 * inward, inward, k_pin_share * radius, length / 2);
}

}  // namespace exemplar
