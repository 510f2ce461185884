#pragma once

#include <Eigen/Core>
#include <variant>
#include <vector>

#include "host/mesh/mesh.h"

namespace exemplar {

/// Two spheres and the cone that touches both: a capsule with two radii (> 0) along +y from the local origin.
struct RoundCone {
    float length, radius_begin, radius_end;
};
/// Axis-aligned in the local frame; semi-axes > 0.
struct Ellipsoid {
    Vec3 radius;
};
/// Axis-aligned in the local frame; half extents include the edge rounding.
struct RoundBox {
    Vec3 half;
    float rounding;
};
/// Around the local y axis; half height and radius include the edge rounding.
struct RoundCylinder {
    float half_height, radius, rounding;
};
/// Around the local y axis.
struct Torus {
    float major, minor;
};
/// A polygon in the local xz plane (any orientation, not self-intersecting), extruded along y to +-half_height, then
/// offset outward by `rounding`.
struct Prism {
    std::vector<Vec2> outline;
    float half_height, rounding;
};
/// A polyline in the (radius, y) half plane, rotated around the local y axis; thickness[i] > 0 is half the wall at
/// point i.
struct Lathe {
    std::vector<Vec2> profile;
    std::vector<float> thickness;
};

/// Spheres swept along a polyline of at least two points; the radius (> 0) varies linearly from point to point.
struct Tube {
    std::vector<Vec3> points;
    std::vector<float> radii;
};

using Solid = std::variant<RoundCone, Ellipsoid, RoundBox, RoundCylinder, Torus, Prism, Lathe, Tube>;

/// Returns the distance of local point p to the surface, negative inside. Exact outside except for the ellipsoid and
/// the tapered tube, whose values are first-order estimates. The gradient is about 1.
float solid_distance(const Solid& solid, const Vec3& p);

/// A ball in local coordinates that contains the solid.
struct Ball {
    Vec3 center;
    float radius;
};
Ball bounding_ball(const Solid& solid);
/// Returns local balls that together contain the solid, for a tight bounding box: one per point of a tube, else the
/// bounding ball.
std::vector<Ball> covering_balls(const Solid& solid);

}  // namespace exemplar
