#include "host/parts/prototype/print_joint.h"

#include "host/parts/prototype/print_shapes.h"

namespace exemplar {

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
