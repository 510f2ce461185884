#pragma once

#include <cstdint>
#include <vector>

#include "host/mesh/mesh.h"
#include "host/parts/rigging/skeleton.h"

namespace exemplar {

enum class PrintJointKind { ball, hinge, fused };

/// A joint between two printed solids: a ball (or the barrel of a hinge) on a pin of the child, in a socket of the
/// parent. Lengths are in millimeters.
struct PrintJoint {
    PrintJointKind kind = PrintJointKind::ball;
    std::uint32_t joint = 0;  ///< of the skeleton
    Vec3 center;              ///< of the ball, inside the parent
    Vec3 inward;              ///< unit, from the child into the parent
    Vec3 hinge;               ///< unit, the axis of a hinge, normal to `inward`
    float radius = 0;

    /// Returns the signed distance of a point to the ball or barrel, grown by `gap`; negative inside.
    float head_distance(const Vec3& point, float gap) const;
    /// Returns the signed distance of a point to the pin, from the center of the ball into the child.
    float pin_distance(const Vec3& point) const;
};

/// The center of the ball lies this many radii inside the parent, so that the socket holds more than half of it.
constexpr float k_ball_depth = 0.55F;
/// The radius of the pin in radii of the ball.
constexpr float k_pin_share = 0.5F;

}  // namespace exemplar
