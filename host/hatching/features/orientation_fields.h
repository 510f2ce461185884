#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "host/mesh/mesh.h"

namespace exemplar {

/// Orientation features (thesis App. B.3): this many fields, followed by the same fields rotated by 90 degrees.
constexpr std::size_t k_orientation_fields = 35;
constexpr std::size_t k_orientation_features = 2 * k_orientation_fields;

/// An unsigned direction as a vector of doubled angle, (cos 2 theta, sin 2 theta) (thesis Eq. 4.6): unit, or zero
/// where there is no direction. Rotating the direction by 90 degrees negates the vector.
using DoubledAngle = std::array<float, 2>;

inline DoubledAngle operator*(float factor, const DoubledAngle& v) {
    return {factor * v[0], factor * v[1]};
}
inline float squared_distance(const DoubledAngle& a, const DoubledAngle& b) {
    const float x = a[0] - b[0], y = a[1] - b[1];
    return x * x + y * y;
}
/// Returns v scaled to unit length, or zero if it is shorter than 1e-6.
DoubledAngle normalized(const DoubledAngle& v);
/// Returns the doubled angle of an angle in radians.
DoubledAngle doubled_angle(float angle);
/// Returns the doubled angle of a direction in the image; its sign does not matter.
DoubledAngle doubled_angle(const Vec2& direction);
/// Returns the angle, in [0, pi).
float angle_of(const DoubledAngle& v);

/// Orientation features of some items (pixels).
struct OrientationFields {
    std::size_t rows = 0;
    std::vector<DoubledAngle> values;  ///< k_orientation_fields x rows

    explicit OrientationFields(std::size_t count = 0) : rows(count), values(k_orientation_fields * count) {}
    std::span<DoubledAngle> field(std::size_t k) { return {values.data() + k * rows, rows}; }
    std::span<const DoubledAngle> field(std::size_t k) const { return {values.data() + k * rows, rows}; }
    /// Returns feature k, below k_orientation_features, of item i.
    DoubledAngle feature(std::size_t k, std::size_t i) const {
        if (k < k_orientation_fields) return values[k * rows + i];
        return -1.0f * values[(k - k_orientation_fields) * rows + i];
    }
};

}  // namespace exemplar
