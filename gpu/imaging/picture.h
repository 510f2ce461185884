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

/// The columns of a matrix as shaders take them.
inline void put_matrix(const Eigen::Matrix4f& matrix, shared::vec4 (&columns)[4]) {
    for (int column = 0; column < 4; ++column)
        columns[column] = {matrix(0, column), matrix(1, column), matrix(2, column), matrix(3, column)};
}

/// Whether the eye of a camera is at infinity.
inline bool is_parallel(const Camera& camera) {
    return camera.projection(3, 3) != 0;
}

/// The eye as a homogeneous point: of a parallel projection the unit direction to it, and 0.
inline shared::vec4 homogeneous_eye(const Camera& camera) {
    const bool parallel = is_parallel(camera);
    const Vec3 eye = parallel ? camera.to_eye(Vec3::Zero()) : camera.position();
    return {eye.x(), eye.y(), eye.z(), parallel ? 0.0f : 1.0f};
}

/// A color as unpackUnorm4x8 takes it, red lowest.
inline std::uint32_t packed_color(const Color& color) {
    return color[0] | std::uint32_t{color[1]} << 8 | std::uint32_t{color[2]} << 16;
}

inline std::vector<std::uint32_t> packed_colors(std::span<const Color> colors) {
    std::vector<std::uint32_t> packed;
    packed.reserve(colors.size());
    for (const Color& color : colors) packed.push_back(packed_color(color));
    return packed;
}

/// A color from 0 to 1 as attachments of 8 bits are cleared to.
inline std::array<float, 4> clear_value(const Color& color) {
    return {static_cast<float>(color[0]) / 255, static_cast<float>(color[1]) / 255, static_cast<float>(color[2]) / 255,
            1};
}

}  // namespace exemplar
