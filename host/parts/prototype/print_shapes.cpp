#include "host/parts/prototype/print_shapes.h"

#include <algorithm>
#include <cmath>

namespace exemplar {

float cylinder_distance(const Vec3& point, const Vec3& center, const Vec3& axis, float radius, float half_length) {
    const Vec3 p = point - center;
    const float along = std::abs(p.dot(axis)) - half_length;
    const float around = (p - p.dot(axis) * axis).norm() - radius;
    const float outside = std::hypot(std::max(along, 0.0F), std::max(around, 0.0F));
    return outside + std::min(std::max(along, around), 0.0F);
}

float box_distance(const Vec3& point, const Vec3& low, const Vec3& high) {
    const Vec3 beyond = (low - point).cwiseMax(point - high);
    return beyond.cwiseMax(0.0F).norm() + std::min(beyond.maxCoeff(), 0.0F);
}

}  // namespace exemplar
