#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "host/mesh/mesh.h"

namespace exemplar {

/// Orientation features: the 35 fields of thesis App. B.3, the same rotated by 90 degrees, three further fields, and
/// these rotated.
constexpr std::size_t k_thesis_fields = 35, k_orientation_fields = k_thesis_fields + 3;
constexpr std::size_t k_orientation_features = 2 * k_orientation_fields;
/// Returns the field of a feature.
constexpr std::size_t field_of_feature(std::size_t feature) {
    if (feature < 2 * k_thesis_fields) return feature % k_thesis_fields;
    return feature - (feature < k_thesis_fields + k_orientation_fields ? k_thesis_fields : k_orientation_fields);
}
/// Returns whether a feature is its field rotated by 90 degrees.
constexpr bool is_rotated(std::size_t feature) {
    return feature < 2 * k_thesis_fields ? feature >= k_thesis_fields
                                         : feature >= k_thesis_fields + k_orientation_fields;
}
/// Returns the number of a field, or of the field rotated by 90 degrees, among the features.
constexpr std::uint32_t feature_of_field(std::size_t field, bool rotated = false) {
    const std::size_t own = field < k_thesis_fields ? field : field + k_thesis_fields;
    const std::size_t step = field < k_thesis_fields ? k_thesis_fields : k_orientation_fields - k_thesis_fields;
    return static_cast<std::uint32_t>(rotated ? own + step : own);
}

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
        const DoubledAngle& v = values[field_of_feature(k) * rows + i];
        return is_rotated(k) ? -1.0f * v : v;
    }
};

}  // namespace exemplar
