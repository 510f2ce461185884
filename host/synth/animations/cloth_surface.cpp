#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "host/core/random.h"
#include "host/synth/animations/cloth.h"

namespace exemplar {
namespace {

constexpr double k_jitter = 0.16;  // maximum displacement of vertices, as a share of the spacing

/// Returns the four cubic B-spline weights at t in [0, 1] of a segment.
std::array<double, 4> spline_weights(double t) {
    const double u = 1 - t;
    return {u * u * u / 6, (3 * t * t * t - 6 * t * t + 4) / 6, (3 * u * u * u - 6 * u * u + 4) / 6, t * t * t / 6};
}

/// Returns the particles with one more row and column on each side, extrapolated linearly, so that the surface ends
/// where the particles do.
std::vector<Vec3d> padded(const ClothGrid& grid, const std::vector<Vec3d>& particles) {
    const std::size_t columns = grid.columns + 2, rows = grid.rows + 2;
    std::vector<Vec3d> result(columns * rows);
    const auto at = [&](std::size_t c, std::size_t r) -> Vec3d& { return result[r * columns + c]; };
    for (std::size_t r = 0; r < grid.rows; ++r) {
        for (std::size_t c = 0; c < grid.columns; ++c) at(c + 1, r + 1) = particles[grid.index(c, r)];
        at(0, r + 1) = 2 * at(1, r + 1) - at(2, r + 1);
        at(columns - 1, r + 1) = 2 * at(columns - 2, r + 1) - at(columns - 3, r + 1);
    }
    for (std::size_t c = 0; c < columns; ++c) {
        at(c, 0) = 2 * at(c, 1) - at(c, 2);
        at(c, rows - 1) = 2 * at(c, rows - 2) - at(c, rows - 3);
    }
    return result;
}

}  // namespace

ClothSurface::ClothSurface(const ClothGrid& grid, std::size_t vertices, std::uint64_t seed) : grid_(grid) {
    // Side length of equilateral triangles: there is one vertex per side^2 sqrt(3) / 2.
    Random random(seed);
    const double side = std::sqrt(grid.width * grid.height * 2 / std::numbers::sqrt3 / static_cast<double>(vertices));
    const auto count = static_cast<std::size_t>(std::max(std::lround(grid.height / (side * 0.8660254)), 2L));
    const auto across = static_cast<std::size_t>(
        std::max(std::lround(static_cast<double>(vertices) / static_cast<double>(count + 1)), 4L));
    const double dx = grid.width / static_cast<double>(across - 1), dy = grid.height / static_cast<double>(count);
    std::size_t lower = 0;
    for (std::size_t r = 0; r <= count; ++r) {
        const std::size_t upper = parameters_.size();
        const bool is_border = r == 0 || r == count, is_odd = r % 2 == 1;
        const double y = static_cast<double>(r) * dy;
        add_vertex(0, y);
        for (std::size_t c = 1; c + 1 < across + (is_odd ? 1 : 0); ++c) {
            const double x = (static_cast<double>(c) - (is_odd ? 0.5 : 0.0)) * dx;
            const double jitter_x = k_jitter * dx * random.uniform(-1, 1),
                         jitter_y = k_jitter * dy * random.uniform(-1, 1);
            add_vertex(is_border ? x : x + jitter_x, is_border ? y : y + jitter_y);
        }
        add_vertex(grid.width, y);
        if (r > 0) zip_rows(lower, upper, upper, parameters_.size());
        lower = upper;
    }
}

void ClothSurface::add_vertex(double x, double y) {
    parameters_.emplace_back(static_cast<float>(x / grid_.cell_width()), static_cast<float>(y / grid_.cell_height()));
}

/// Adds the triangles between two rows of vertices (ranges of indices), from left to right.
void ClothSurface::zip_rows(std::size_t lower, std::size_t lower_end, std::size_t upper, std::size_t upper_end) {
    std::size_t a = lower, b = upper;
    while (a + 1 < lower_end || b + 1 < upper_end) {
        // Takes the shorter of the two possible next edges; at the ends of rows there is only one.
        const bool can_a = a + 1 < lower_end, can_b = b + 1 < upper_end;
        const float next_a = can_a ? (parameters_[a + 1] - parameters_[b]).squaredNorm() : 0;
        const float next_b = can_b ? (parameters_[b + 1] - parameters_[a]).squaredNorm() : 0;
        const bool takes_a = can_a && (!can_b || next_a <= next_b);
        const std::size_t next = takes_a ? ++a : ++b;
        const std::size_t before = takes_a ? a - 1 : a, other = takes_a ? b : b - 1;
        faces_.push_back(
            {static_cast<std::uint32_t>(before), static_cast<std::uint32_t>(next), static_cast<std::uint32_t>(other)});
    }
}

std::vector<Vec3> ClothSurface::vertices(const std::vector<Vec3d>& particles) const {
    const std::vector<Vec3d> control = padded(grid_, particles);
    const std::size_t columns = grid_.columns + 2;
    std::vector<Vec3> result;
    result.reserve(parameters_.size());
    for (const Vec2& p : parameters_) {
        const auto i = std::min(static_cast<std::size_t>(p.x()), grid_.columns - 2);
        const auto j = std::min(static_cast<std::size_t>(p.y()), grid_.rows - 2);
        const auto wx = spline_weights(static_cast<double>(p.x()) - static_cast<double>(i));
        const auto wy = spline_weights(static_cast<double>(p.y()) - static_cast<double>(j));
        Vec3d sum = Vec3d::Zero();
        for (std::size_t r = 0; r < 4; ++r)
            for (std::size_t c = 0; c < 4; ++c) sum += wy[r] * wx[c] * control[(j + r) * columns + i + c];
        result.push_back(sum.cast<float>());
    }
    return result;
}

}  // namespace exemplar
