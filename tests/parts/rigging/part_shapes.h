#pragma once

#include <cmath>
#include <numbers>

#include "host/mesh/mesh.h"

namespace exemplar::part_shapes {

/// A closed tube of radius 1 along x from 0 to `length`, 16 corners around, with a ring every half unit.
inline TriangleMesh tube(std::uint32_t length) {
    constexpr std::uint32_t k_around = 16;
    TriangleMesh mesh;
    const std::uint32_t rings = 2 * length + 1;
    for (std::uint32_t i = 0; i < rings; ++i)
        for (std::uint32_t j = 0; j < k_around; ++j) {
            const float angle = 2 * std::numbers::pi_v<float> * static_cast<float>(j) / k_around;
            mesh.vertices.emplace_back(static_cast<float>(i) / 2, std::cos(angle), std::sin(angle));
        }
    const auto at = [](std::uint32_t i, std::uint32_t j) { return i * k_around + j % k_around; };
    for (std::uint32_t i = 0; i + 1 < rings; ++i)
        for (std::uint32_t j = 0; j < k_around; ++j) {
            mesh.faces.push_back({at(i, j), at(i, j + 1), at(i + 1, j)});
            mesh.faces.push_back({at(i + 1, j), at(i, j + 1), at(i + 1, j + 1)});
        }
    mesh.vertices.emplace_back(0, 0, 0);
    mesh.vertices.emplace_back(static_cast<float>(length), 0, 0);
    const std::uint32_t low = rings * k_around, high = low + 1;
    for (std::uint32_t j = 0; j < k_around; ++j) {
        mesh.faces.push_back({low, at(0, j + 1), at(0, j)});
        mesh.faces.push_back({high, at(rings - 1, j), at(rings - 1, j + 1)});
    }
    mesh.source_face_count = static_cast<std::uint32_t>(mesh.faces.size());
    return mesh;
}

/// A label per face: how many of the `limits` the x coordinate of the center of the face is above.
inline std::vector<std::int32_t> labels_along_x(const TriangleMesh& mesh, const std::vector<float>& limits) {
    std::vector<std::int32_t> label;
    for (const Vec3& center : face_centers(mesh)) {
        label.push_back(0);
        for (const float limit : limits) label.back() += center.x() > limit;
    }
    return label;
}

/// Appends a mesh, moved by `offset`, as another component.
inline void append(TriangleMesh& mesh, const TriangleMesh& other, const Vec3& offset) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const Vec3& v : other.vertices) mesh.vertices.push_back(v + offset);
    for (const Face& face : other.faces) mesh.faces.push_back({face[0] + first, face[1] + first, face[2] + first});
    mesh.source_face_count = static_cast<std::uint32_t>(mesh.faces.size());
}

}  // namespace exemplar::part_shapes
