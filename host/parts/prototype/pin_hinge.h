#pragma once

#include "host/mesh/mesh.h"

namespace exemplar {

/// A hinge with an upright pin at the inner face of an arm of glasses: three knuckles around the pin, of which the
/// outer ones and the pin belong to the frame and the middle one to the arm. In print they are apart by `gap`. As the
/// pin lies at the inner face, an arm that turns inward moves away from the cut. Lengths are in millimeters.
struct PinHinge {
    Vec3 center = Vec3::Zero();        ///< on the axis, at half its height; the axis is y
    Vec3 back = -Vec3::UnitZ();        ///< unit, level: out of the cut into the arm
    Vec3 inward = -Vec3::UnitX();      ///< unit, level and normal to `back`: towards which the arm turns
    float radius = 0, pin_radius = 0;  ///< of knuckles and pin; the arm's inner face is `radius` away from the axis
    float height = 0;                  ///< of all knuckles together
    float arm_width = 0;               ///< of the arm at the cut
    float gap = 0;

    /// Returns the coordinates of a point: inward, up and back from the center.
    Vec3 local(const Vec3& point) const;
    /// Returns where a point of the arm is once the arm is turned by so many radians.
    Vec3 turned(const Vec3& point, float angle) const;
    /// Returns the signed distance to the knuckles, bracket and pin of the frame.
    float frame_part(const Vec3& point) const;
    /// Returns the signed distance to the knuckle of the arm and its bracket, without the hole for the pin.
    float arm_part(const Vec3& point) const;
    /// Returns the signed distance to what the arm sweeps near the hinge, grown by the gap: the frame must not be
    /// there.
    float room_of_arm(const Vec3& point) const;
    /// Returns the signed distance to the frame's knuckles and pin, grown by the gap: the arm must not be there.
    float room_of_frame(const Vec3& point) const;

  private:
    float middle() const { return 0.2F * height; }  ///< half of the height of the arm's knuckle
};

/// The smallest radius of a hinge with this gap: the pin, the gap and a wall.
float smallest_hinge(float gap);
/// The radius of the pin in a knuckle of this radius.
float pin_of_hinge(float radius, float gap);

}  // namespace exemplar
