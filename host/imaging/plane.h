#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace exemplar {

/// An image in double precision, for filters that work in several steps; zero outside.
struct Plane {
    std::size_t width = 0, height = 0;
    std::vector<double> values;  ///< row by row

    Plane() = default;
    Plane(std::size_t plane_width, std::size_t plane_height)
        : width(plane_width), height(plane_height), values(plane_width * plane_height) {}
    std::span<double> row(std::size_t y) { return std::span(values).subspan(y * width, width); }
    std::span<const double> row(std::size_t y) const { return std::span(values).subspan(y * width, width); }
};

/// Returns out(x, y) = sum of weights[radius + k] in(x + k, y) over k from -radius to radius; `weights` has 2 radius
/// + 1.
Plane weighted_sums_along_x(const Plane& in, std::span<const double> weights);
/// Sums in(x, y + k) likewise.
Plane weighted_sums_along_y(const Plane& in, std::span<const double> weights);

}  // namespace exemplar
