#pragma once

#include <Eigen/Geometry>
#include <span>

#include "host/imaging/camera.h"
#include "host/mesh/mesh.h"

namespace exemplar {

/// A ball around the object, in mesh units.
struct ViewBall {
    Vec3 center = Vec3::Zero();
    float radius = 1;
};
/// Returns a ball around all points, with a positive radius.
ViewBall ball_around(std::span<const Vec3> points);

/// Size of a picture in pixels.
struct ViewSize {
    int width = 1, height = 1;
};

enum class ViewSide { front, back, left, right, top, bottom };

/// A camera moved by the mouse. It orbits around a target by Bell's trackball, which never jumps or flips, pans so
/// that the target follows the cursor, and zooms towards the cursor. Cursors are in pixels, (0, 0) the upper left
/// corner.
class OrbitCamera {
  public:
    /// Shows the whole ball, without changing the rotation.
    void fit(const ViewBall& ball, ViewSize size);
    /// Rotates by a movement of the cursor.
    void orbit(const Vec2& from, const Vec2& to, ViewSize size);
    /// Rotates around the picture's up axis and its right axis, in radians.
    void turn(float around_up, float around_right);
    /// Moves so that points at the target's depth follow the cursor.
    void pan(const Vec2& from, const Vec2& to, ViewSize size);
    /// Zooms in by a factor (below 1: out); the point under the cursor at the target's depth stays in place.
    void zoom(float factor, const Vec2& cursor, ViewSize size);
    /// Look from a side, or keep the viewing direction and turn +y up.
    void look_from(ViewSide side);
    void turn_upright();
    /// Looks at a point from the direction of `normal`, as near as before.
    void look_at_place(const Vec3& point, const Vec3& normal);
    void set_parallel(bool parallel) { parallel_ = parallel; }
    bool parallel() const { return parallel_; }

    Camera camera(ViewSize size) const;
    const Vec3& target() const { return target_; }
    float distance() const { return distance_; }
    /// From view space to the world.
    const Eigen::Quaternionf& rotation() const { return rotation_; }

  private:
    float half_height() const;  // of what is seen at the target's depth, in mesh units
    Vec2 on_target_plane(const Vec2& cursor, ViewSize size) const;
    ViewBall ball_;
    Vec3 target_ = Vec3::Zero();
    Eigen::Quaternionf rotation_ = Eigen::Quaternionf::Identity();
    float distance_ = 5;
    bool parallel_ = false;
};

}  // namespace exemplar
