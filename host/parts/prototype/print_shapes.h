#pragma once

#include "host/mesh/mesh.h"

namespace exemplar {

/// Returns the signed distance of a point to a cylinder with flat ends; negative inside. `axis` is a unit vector.
float cylinder_distance(const Vec3& point, const Vec3& center, const Vec3& axis, float radius, float half_length);
/// Returns the signed distance of a point to an axis-aligned box; negative inside.
float box_distance(const Vec3& point, const Vec3& low, const Vec3& high);

}  // namespace exemplar
