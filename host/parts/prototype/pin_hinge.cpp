#include "host/parts/prototype/pin_hinge.h"

#include <algorithm>
#include <cmath>

#include "host/parts/prototype/print_shapes.h"

namespace exemplar {
namespace {

/// The thinnest pin and wall that can be printed, in mm.
constexpr float k_least_pin = 0.9F, k_least_wall = 0.9F;
/// How far brackets reach into the frame and the arm, in radii.
constexpr float k_bracket_reach = 2.2F;

/// Distance to a cylinder around the axis, in local coordinates.
float around_pin(const Vec3& local, float y_center, float radius, float half_height) {
    return cylinder_distance(local, Vec3(0, y_center, 0), Vec3::UnitY(), radius, half_height);
}

}  // namespace

Vec3 PinHinge::local(const Vec3& point) const {
    const Vec3 p = point - center;
    return {p.dot(inward), p.y(), p.dot(back)};
}

Vec3 PinHinge::turned(const Vec3& point, float angle) const {
    const Vec3 p = local(point);
    const float c = std::cos(angle), s = std::sin(angle);
    return center + (c * p.x() + s * p.z()) * inward + p.y() * Vec3::UnitY() + (c * p.z() - s * p.x()) * back;
}

float PinHinge::frame_part(const Vec3& point) const {
    const Vec3 p = local(point);
    const float low = middle() + gap, half = (height / 2 - low) / 2, outer = low + half;
    const float reach = k_bracket_reach * radius, inner = -radius - arm_width / 2;
    const Vec3 upper(p.x(), std::abs(p.y()), p.z());
    const float knuckle = around_pin(upper, outer, radius, half);
    const float link = box_distance(upper, {inner, low, -reach}, {-gap / 2, height / 2, -gap / 2});
    const float bracket = box_distance(p, {inner, -height / 2, -reach - gap}, {-gap / 2, height / 2, -radius - gap});
    return std::min({knuckle, link, bracket, around_pin(p, 0, pin_radius, height / 2)});
}

float PinHinge::arm_part(const Vec3& point) const {
    const Vec3 p = local(point);
    const float reach = k_bracket_reach * radius, inner = -radius - arm_width / 2;
    const float link = box_distance(p, {inner, -middle(), gap / 2}, {-gap / 2, middle(), reach});
    const float bracket = box_distance(p, {inner, -height / 2, radius + gap}, {-gap / 2, height / 2, reach + gap});
    return std::min({around_pin(p, 0, radius, middle()), link, bracket});
}

float PinHinge::room_of_arm(const Vec3& point) const {
    const Vec3 p = local(point);
    const float swept = around_pin(p, 0, (k_bracket_reach + 0.2F) * radius + 2 * gap, height / 2 + gap);
    return std::min(arm_part(point) - gap, std::max(swept, -p.z() - gap / 2));
}

float PinHinge::room_of_frame(const Vec3& point) const {
    const Vec3 p = local(point);
    const float half = (height / 2 - middle()) / 2 + gap;
    const float knuckles = around_pin({p.x(), std::abs(p.y()), p.z()}, middle() + half, radius + gap, half);
    return std::min(knuckles, around_pin(p, 0, pin_radius + gap, height / 2 + gap));
}

float smallest_hinge(float gap) {
    return k_least_pin + gap + k_least_wall;
}

float pin_of_hinge(float radius, float gap) {
    return std::max(k_least_pin, (radius - gap) / 2);
}

}  // namespace exemplar
