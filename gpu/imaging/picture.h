#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "host/imaging/camera.h"
#include "host/mesh/labels.h"
#include "shaders/shared/types.h"

namespace exemplar {

/// Stores the columns of a matrix in the layout of shaders.
inline void put_matrix(const Eigen::Matrix4f& matrix, shared::vec4 (&columns)[4]) {
    for (int column = 0; column < 4; ++column)
        columns[column] = {matrix(0, column), matrix(1, column), matrix(2, column), matrix(3, column)};
}

/// Returns whether the eye of a camera is at infinity.
inline bool is_parallel(const Camera& camera) {
    return camera.projection(3, 3) != 0;
}

/// Returns the eye as a homogeneous point; for a parallel projection, the unit direction to it and 0.
inline shared::vec4 homogeneous_eye(const Camera& camera) {
    const bool parallel = is_parallel(camera);
    const Vec3 eye = parallel ? camera.to_eye(Vec3::Zero()) : camera.position();
    return {eye.x(), eye.y(), eye.z(), parallel ? 0.0f : 1.0f};
}

/// Returns a color in the layout of unpackUnorm4x8, red in the lowest byte.
inline std::uint32_t packed_color(const Color& color) {
    return color[0] | std::uint32_t{color[1]} << 8 | std::uint32_t{color[2]} << 16;
}

inline std::vector<std::uint32_t> packed_colors(std::span<const Color> colors) {
    std::vector<std::uint32_t> packed;
    packed.reserve(colors.size());
    for (const Color& color : colors) packed.push_back(packed_color(color));
    return packed;
}

/// Returns the value from 0 to 1 that clears attachments of 8 bits to a color.
inline std::array<float, 4> clear_value(const Color& color) {
    return {static_cast<float>(color[0]) / 255, static_cast<float>(color[1]) / 255, static_cast<float>(color[2]) / 255,
            1};
}

}  // namespace exemplar
