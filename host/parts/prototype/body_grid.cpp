#include "host/parts/prototype/body_grid.h"

#include <algorithm>
#include <cmath>

#include "host/core/parallel.h"
#include "host/parts/prototype/solid_distance.h"

namespace exemplar {
namespace {

/// For each node whether a node within two steps along the line is marked.
std::vector<std::uint8_t> spread_along(const std::vector<std::uint8_t>& mark, std::size_t stride, std::size_t count) {
    std::vector<std::uint8_t> spread(mark.size());
    parallel_ranges(mark.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t n = begin; n < end; ++n) {
            const std::size_t at = n / stride % count;
            std::uint8_t any = mark[n];
            for (std::size_t step = 1; step <= 2; ++step) {
                if (at >= step) any |= mark[n - step * stride];
                if (at + step < count) any |= mark[n + step * stride];
            }
            spread[n] = any;
        }
    });
    return spread;
}

/// Bit 0: a node near is inside. Bit 1: a node near is outside.
std::vector<std::uint8_t> kinds_near(const std::vector<bool>& inside, const std::array<std::uint32_t, 3>& size) {
    std::vector<std::uint8_t> kind(inside.size());
    for (std::size_t n = 0; n < kind.size(); ++n) kind[n] = inside[n] ? 1 : 2;
    std::size_t stride = 1;
    for (const std::uint32_t count : size) {
        kind = spread_along(kind, stride, count);
        stride *= count;
    }
    return kind;
}

}  // namespace

ValueGrid body_distances(const TriangleMesh& mesh, float cell, float margin) {
    const BoundingBox box = bounding_box(mesh);
    ValueGrid grid;
    grid.cell = cell;
    grid.origin = box.low.cast<float>() - Vec3::Constant(margin);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<Eigen::Index>(axis);
        grid.size[axis] =
            static_cast<std::uint32_t>((static_cast<float>(box.high[a] - box.low[a]) + 2 * margin) / cell) + 2;
    }
    std::vector<std::uint32_t> all(mesh.face_count());
    for (std::uint32_t f = 0; f < all.size(); ++f) all[f] = f;
    const SurfaceDistance surface(mesh, all, 0.7F * cell);
    const std::vector<bool> inside = nodes_inside(mesh, grid.size, grid.origin, cell);
    const std::vector<std::uint8_t> near = kinds_near(inside, grid.size);
    grid.value.resize(inside.size());
    parallel_for(grid.size[2], [&](std::size_t layer) {
        const auto z = static_cast<std::uint32_t>(layer);
        for (std::uint32_t y = 0; y < grid.size[1]; ++y)
            for (std::uint32_t x = 0; x < grid.size[0]; ++x) {
                const std::size_t n = grid.index(x, y, z);
                const float reach = k_body_reach * cell;
                const float distance = near[n] == 3 ? std::min(surface(grid.position(x, y, z)), reach) : reach;
                grid.value[n] = inside[n] ? -distance : distance;
            }
    });
    return grid;
}

float value_at(const ValueGrid& grid, const Vec3& point) {
    std::array<std::uint32_t, 3> node{};
    Vec3 share;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<Eigen::Index>(axis);
        const float at =
            std::clamp((point[a] - grid.origin[a]) / grid.cell, 0.0F, static_cast<float>(grid.size[axis] - 1));
        node[axis] = std::min(static_cast<std::uint32_t>(at), grid.size[axis] - 2);
        share[a] = at - static_cast<float>(node[axis]);
    }
    float sum = 0;
    for (std::uint32_t corner = 0; corner < 8; ++corner) {
        const std::array<std::uint32_t, 3> step{corner & 1, corner >> 1 & 1, corner >> 2};
        float weight = 1;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto a = static_cast<Eigen::Index>(axis);
            weight *= step[axis] == 1 ? share[a] : 1 - share[a];
        }
        sum += weight * grid.value[grid.index(node[0] + step[0], node[1] + step[1], node[2] + step[2])];
    }
    return sum;
}

}  // namespace exemplar
