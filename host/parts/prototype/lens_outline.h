#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "host/mesh/mesh.h"

namespace exemplar {

/// Signed distances in a plane at the nodes of a square grid, negative inside of an outline.
struct OutlineGrid {
    std::uint32_t width = 0, height = 0;  ///< in nodes
    Vec2 origin = Vec2::Zero();
    float cell = 1;
    std::vector<float> value;  ///< by increasing y, x

    std::size_t index(std::uint32_t x, std::uint32_t y) const { return std::size_t{y} * width + x; }
    Vec2 position(std::uint32_t x, std::uint32_t y) const {
        return origin + cell * Vec2(static_cast<float>(x), static_cast<float>(y));
    }
    /// Returns the value at a point, linear between nodes; the border's value outside of the grid.
    float operator()(const Vec2& point) const;
};

/// Returns the signed distances to the silhouette of some faces seen along z, where only points that are `allowed`
/// count as covered. They are exact to about a cell, and smoothed over two cells.
OutlineGrid silhouette_distances(const TriangleMesh& mesh, const std::vector<std::uint32_t>& faces, float cell,
                                 const std::function<bool(const Vec2&)>& allowed);

/// Makes all values outside of the largest connected area of negative ones positive.
void keep_largest_area(OutlineGrid& grid);

/// Returns the closed polygons around the negative values, inside on the left (marching squares).
std::vector<std::vector<Vec2>> outlines_of(const OutlineGrid& grid);

}  // namespace exemplar
