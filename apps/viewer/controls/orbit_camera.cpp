#include "apps/viewer/controls/orbit_camera.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace exemplar {
namespace {

constexpr float k_field_of_view = 0.6f;  // radians, along the shorter side of the picture when it fits
constexpr float k_free_margin = 1.02f;

// Returns the point of a cursor on a ball of radius 1 in front of the picture. Far out the ball continues as a
// hyperbola, so that every cursor has a point.
Vec3 on_trackball(const Vec2& cursor, ViewSize size) {
    const float shorter = static_cast<float>(std::max(1, std::min(size.width, size.height)));
    const float x = (2 * cursor.x() - static_cast<float>(size.width)) / shorter,
                y = (static_cast<float>(size.height) - 2 * cursor.y()) / shorter;
    const float squared = x * x + y * y;
    const float z = squared <= 0.5f ? std::sqrt(1 - squared) : 0.5f / std::sqrt(squared);
    return Vec3(x, y, z).normalized();
}

float aspect_of(ViewSize size) {
    return static_cast<float>(std::max(size.width, 1)) / static_cast<float>(std::max(size.height, 1));
}

}  // namespace

ViewBall ball_around(std::span<const Vec3> points) {
    if (points.empty()) return {};
    Vec3 low = points[0], high = low;
    for (const Vec3& p : points) {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
    }
    ViewBall ball{0.5f * low + 0.5f * high, 0};
    for (const Vec3& p : points) ball.radius = std::max(ball.radius, (p - ball.center).norm());
    ball.radius = std::max({ball.radius, 1e-5f * ball.center.norm(), 1e-12f});
    return ball;
}

void OrbitCamera::fit(const ViewBall& ball, ViewSize size) {
    ball_ = ball;
    target_ = ball.center;
    const float shorter = std::min(1.0f, aspect_of(size));
    const float half_angle = std::atan(std::tan(k_field_of_view / 2) * shorter);
    distance_ = k_free_margin * ball.radius / std::sin(half_angle);
}

void OrbitCamera::orbit(const Vec2& from, const Vec2& to, ViewSize size) {
    const Eigen::Quaternionf turned =
        Eigen::Quaternionf::FromTwoVectors(on_trackball(from, size), on_trackball(to, size));
    // The ball turns with the cursor, so the camera turns against it.
    rotation_ = (rotation_ * turned.conjugate()).normalized();
}

void OrbitCamera::turn(float around_up, float around_right) {
    rotation_ =
        (rotation_ * Eigen::AngleAxisf(-around_up, Vec3::UnitY()) * Eigen::AngleAxisf(-around_right, Vec3::UnitX()))
            .normalized();
}

float OrbitCamera::half_height() const {
    return distance_ * std::tan(k_field_of_view / 2);
}

// Returns the offset from the picture's center, in mesh units, y up.
Vec2 OrbitCamera::on_target_plane(const Vec2& cursor, ViewSize size) const {
    const float pixel = 2 * half_height() / static_cast<float>(std::max(size.height, 1));
    return pixel * Vec2(cursor.x() - 0.5f * static_cast<float>(size.width),
                        0.5f * static_cast<float>(size.height) - cursor.y());
}

void OrbitCamera::pan(const Vec2& from, const Vec2& to, ViewSize size) {
    const Vec2 moved = on_target_plane(to, size) - on_target_plane(from, size);
    target_ -= rotation_ * Vec3(moved.x(), moved.y(), 0);
}

void OrbitCamera::zoom(float factor, const Vec2& cursor, ViewSize size) {
    if (!(factor > 0)) return;
    const Vec2 before = on_target_plane(cursor, size);
    distance_ = std::clamp(distance_ / factor, 1e-3f * ball_.radius, 1e3f * ball_.radius);
    const Vec2 moved = before - on_target_plane(cursor, size);
    target_ += rotation_ * Vec3(moved.x(), moved.y(), 0);
}

void OrbitCamera::look_from(ViewSide side) {
    constexpr float k_quarter = std::numbers::pi_v<float> / 2;
    const auto turned = [](float angle, const Vec3& axis) {
        return Eigen::Quaternionf(Eigen::AngleAxisf(angle, axis));
    };
    switch (side) {
        case ViewSide::front:
            rotation_ = Eigen::Quaternionf::Identity();
            break;
        case ViewSide::back:
            rotation_ = turned(2 * k_quarter, Vec3::UnitY());
            break;
        case ViewSide::left:
            rotation_ = turned(-k_quarter, Vec3::UnitY());
            break;
        case ViewSide::right:
            rotation_ = turned(k_quarter, Vec3::UnitY());
            break;
        case ViewSide::top:
            rotation_ = turned(-k_quarter, Vec3::UnitX());
            break;
        case ViewSide::bottom:
            rotation_ = turned(k_quarter, Vec3::UnitX());
            break;
    }
}

// From straight above or below, the picture keeps the up axis it has.
void OrbitCamera::turn_upright() {
    const Vec3 backward = rotation_ * Vec3::UnitZ();
    Vec3 right = Vec3::UnitY().cross(backward);
    if (right.norm() < 1e-3f) return;
    right.normalize();
    Eigen::Matrix3f axes;
    axes.col(0) = right;
    axes.col(1) = backward.cross(right);
    axes.col(2) = backward;
    rotation_ = Eigen::Quaternionf(axes).normalized();
}

void OrbitCamera::look_at_place(const Vec3& point, const Vec3& normal) {
    const Vec3 backward = rotation_ * Vec3::UnitZ();
    rotation_ = (Eigen::Quaternionf::FromTwoVectors(backward, normal) * rotation_).normalized();
    target_ = point;
}

Camera OrbitCamera::camera(ViewSize size) const {
    const Vec3 eye = target_ + rotation_ * Vec3(0, 0, distance_);
    Camera camera;
    const Eigen::Matrix3f to_view = rotation_.conjugate().toRotationMatrix();
    camera.view.topLeftCorner<3, 3>() = to_view;
    camera.view.topRightCorner<3, 1>() = -to_view * eye;
    // The near plane is as close to the ball as possible, for the best depth resolution.
    const float depth = (eye - ball_.center).dot(rotation_ * Vec3::UnitZ());
    const float far = std::max(depth + 1.01f * ball_.radius, 0.02f * ball_.radius);
    if (parallel_) {
        camera.projection = orthographic(half_height(), aspect_of(size), depth - 1.01f * ball_.radius, far);
        return camera;
    }
    const float near = std::max(depth - 1.01f * ball_.radius, 1e-3f * std::min(distance_, ball_.radius));
    camera.projection = perspective(k_field_of_view, aspect_of(size), near, std::max(far, 2 * near));
    return camera;
}

}  // namespace exemplar
