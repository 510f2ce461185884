#include "host/hatching/features/orientation_fields.h"

#include <cmath>
#include <numbers>

namespace exemplar {

DoubledAngle normalized(const DoubledAngle& v) {
    const float length = std::hypot(v[0], v[1]);
    return length > 1e-6f ? (1 / length) * v : DoubledAngle{};
}

DoubledAngle doubled_angle(float angle) {
    return {std::cos(2 * angle), std::sin(2 * angle)};
}

DoubledAngle doubled_angle(const Vec2& direction) {
    return normalized(
        {direction.x() * direction.x() - direction.y() * direction.y(), 2 * direction.x() * direction.y()});
}

float angle_of(const DoubledAngle& v) {
    const float angle = 0.5f * std::atan2(v[1], v[0]);
    return angle < 0 ? angle + std::numbers::pi_v<float> : angle;
}

}  // namespace exemplar
