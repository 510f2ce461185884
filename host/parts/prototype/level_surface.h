#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "host/mesh/mesh.h"

namespace exemplar {

/// Values at the nodes of a cubic grid; node (x, y, z) lies at origin + cell * (x, y, z).
struct ValueGrid {
    std::array<std::uint32_t, 3> size{};  ///< nodes per axis
    Vec3 origin = Vec3::Zero();
    float cell = 1;
    std::vector<float> value;  ///< by increasing z, y, x

    std::size_t index(std::uint32_t x, std::uint32_t y, std::uint32_t z) const {
        return (std::size_t{z} * size[1] + y) * size[0] + x;
    }
    Vec3 position(std::uint32_t x, std::uint32_t y, std::uint32_t z) const {
        return origin + cell * Vec3(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z));
    }
};

/// Returns the surface around the negative values by marching tetrahedra (Doi and Koide 1991): each cube is cut into
/// six tetrahedra around a diagonal, and vertices lie where the value, linear along the edge, is zero. If all values at
/// the border of the grid are positive, the surface is closed, manifold and oriented outward.
TriangleMesh level_surface(const ValueGrid& grid);

}  // namespace exemplar
