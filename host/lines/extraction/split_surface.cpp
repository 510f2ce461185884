#include "host/lines/extraction/split_surface.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>

#include "host/core/disjoint_sets.h"
#include "host/core/errors.h"

namespace exemplar {

namespace {

void check_neighbors(std::span<const Face> faces, std::size_t vertex_count, std::span<const FaceNeighbors> neighbors) {
    if (neighbors.size() != faces.size())
        throw UsageError(fmt::format("neighbors of {} faces for {}: compute them for the same mesh", neighbors.size(),
                                     faces.size()));
    for (std::size_t f = 0; f < faces.size(); ++f)
        for (std::size_t i = 0; i < 3; ++i) {
            if (faces[f][i] >= vertex_count)
                throw MeshError(fmt::format("face {} names vertex {}, but there are {}", f, faces[f][i], vertex_count));
            if (neighbors[f][i] <= k_max_neighbor_code && neighbors[f][i] / 4 >= faces.size())
                throw UsageError(fmt::format("face {} has neighbor {}, but there are {} faces", f, neighbors[f][i] / 4,
                                             faces.size()));
        }
}

}  // namespace

std::vector<Vec3> SplitSurface::positions(std::span<const Vec3> vertices) const {
    std::vector<Vec3> result;
    result.reserve(source.size());
    for (const std::uint32_t v : source) result.push_back(vertices[v]);
    return result;
}

SplitSurface split_at_creases(std::span<const Face> faces, std::span<const Vec3> vertices,
                              std::span<const FaceNeighbors> neighbors, float crease_angle) {
    check_neighbors(faces, vertices.size(), neighbors);
    const auto normal = [&](std::size_t f) -> Vec3 {
        const auto& [a, b, c] = faces[f];
        return (vertices[b] - vertices[a]).cross(vertices[c] - vertices[a]);
    };
    // Faces without area have no normal, so their edges are no creases.
    const auto is_crease = [&](std::size_t f, std::size_t g) {
        const Vec3 a = normal(f), b = normal(g);
        if (!(a.squaredNorm() > 0) || !(b.squaredNorm() > 0)) return false;
        return std::atan2(a.cross(b).norm(), a.dot(b)) > crease_angle;
    };
    DisjointSets corners(3 * faces.size());
    const auto join = [&](std::uint32_t f, std::uint32_t corner, std::uint32_t g) {
        for (std::uint32_t i = 0; i < 3; ++i)
            if (faces[g][i] == faces[f][corner]) corners.join(3 * f + corner, 3 * g + i);
    };
    for (std::uint32_t f = 0; f < faces.size(); ++f)
        for (std::uint32_t i = 0; i < 3; ++i) {
            const std::uint32_t across = neighbors[f][i];
            if (across > k_max_neighbor_code || is_crease(f, across / 4)) continue;
            join(f, i, across / 4);
            join(f, (i + 1) % 3, across / 4);
        }
    SplitSurface split;
    split.faces.resize(faces.size());
    for (std::uint32_t f = 0; f < faces.size(); ++f)
        for (std::uint32_t i = 0; i < 3; ++i) {
            // A set is represented by its smallest corner, which was numbered before all others.
            const std::uint32_t first = corners.find(3 * f + i);
            if (first == 3 * f + i) {
                split.faces[f][i] = static_cast<std::uint32_t>(split.source.size());
                split.source.push_back(faces[f][i]);
            } else {
                split.faces[f][i] = split.faces[first / 3][first % 3];
            }
        }
    return split;
}

}  // namespace exemplar
