#include "host/lines/extraction/split_surface.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "host/core/disjoint_sets.h"
#include "host/core/errors.h"

namespace exemplar {

namespace {

// The largest distance of a smooth surface from the faces of the mesh, as a share of the diagonal. Edges at more than
// the crease angle have the smaller bound.
constexpr float k_max_deviation = 0.0025f, k_max_deviation_at_creases = 0.0008f;

void check_neighbors(std::span<const Face> faces, std::size_t vertex_count, std::span<const FaceNeighbors> neighbors) {
    if (neighbors.size() != faces.size())
        throw UsageError(fmt::format("neighbors of {} faces for {}: compute them for the same mesh", neighbors.size(),
                                     faces.size()));
    for (std::size_t f = 0; f < faces.size(); ++f)
        for (std::size_t i = 0; i < 3; ++i) {
            if (faces[f][i] >= vertex_count)
                throw MeshError(fmt::format("face {} names vertex {}, but there are {}", f, faces[f][i], vertex_count));
            if (has_neighbor(neighbors[f][i]) && neighbor_face(neighbors[f][i]) >= faces.size())
                throw UsageError(fmt::format("face {} has neighbor {}, but there are {} faces", f,
                                             neighbor_face(neighbors[f][i]), faces.size()));
        }
}

float diagonal_of(std::span<const Face> faces, std::span<const Vec3> vertices) {
    Vec3 low = Vec3::Constant(std::numeric_limits<float>::max()), high = -low;
    for (const Face& face : faces)
        for (const std::uint32_t v : face) {
            low = low.cwiseMin(vertices[v]);
            high = high.cwiseMax(vertices[v]);
        }
    return faces.empty() ? 0 : (high - low).norm();
}

}  // namespace

void mark_sharp_edges(std::span<const Face> faces, std::span<const Vec3> vertices, float crease_angle,
                      std::span<FaceNeighbors> neighbors) {
    check_neighbors(faces, vertices.size(), neighbors);
    const auto cross_of = [&](std::uint32_t f) -> Vec3 {
        const auto& [a, b, c] = faces[f];
        return (vertices[b] - vertices[a]).cross(vertices[c] - vertices[a]);
    };
    const float diagonal = diagonal_of(faces, vertices);
    // Faces without area have no normal, so their edges are not sharp.
    const auto is_sharp = [&](std::uint32_t f, std::uint32_t side, std::uint32_t g) {
        const Vec3 a = cross_of(f),
                   b = (oriented_alike(faces, f, side, neighbors[f][side]) ? 1.0f : -1.0f) * cross_of(g);
        if (!(a.squaredNorm() > 0) || !(b.squaredNorm() > 0)) return false;
        const float angle = std::atan2(a.cross(b).norm(), a.dot(b));
        const float most = 8 * diagonal * (angle > crease_angle ? k_max_deviation_at_creases : k_max_deviation);
        const float length = (vertices[faces[f][(side + 1) % 3]] - vertices[faces[f][side]]).norm();
        return angle * std::max(a.norm(), b.norm()) > most * length;
    };
    for (std::uint32_t f = 0; f < faces.size(); ++f)
        for (std::uint32_t i = 0; i < 3; ++i) {
            const std::uint32_t across = neighbors[f][i];
            if (across > k_max_neighbor_code || !owns_edge(f, i, across) || !is_sharp(f, i, across / 4)) continue;
            neighbors[f][i] |= k_sharp_side;
            neighbors[across / 4][across % 4] |= k_sharp_side;
        }
}

std::vector<Vec3> SplitSurface::positions(std::span<const Vec3> vertices) const {
    std::vector<Vec3> result;
    result.reserve(source.size());
    for (const std::uint32_t v : source) result.push_back(vertices[v]);
    return result;
}

SplitSurface split_at_sharp_edges(std::span<const Face> faces, std::size_t vertex_count,
                                  std::span<const FaceNeighbors> neighbors) {
    check_neighbors(faces, vertex_count, neighbors);
    DisjointSets corners(3 * faces.size());
    const auto join = [&](std::uint32_t f, std::uint32_t corner, std::uint32_t g) {
        for (std::uint32_t i = 0; i < 3; ++i)
            if (faces[g][i] == faces[f][corner]) corners.join(3 * f + corner, 3 * g + i);
    };
    for (std::uint32_t f = 0; f < faces.size(); ++f)
        for (std::uint32_t i = 0; i < 3; ++i) {
            const std::uint32_t across = neighbors[f][i];
            if (across > k_max_neighbor_code) continue;
            join(f, i, across / 4);
            join(f, (i + 1) % 3, across / 4);
        }
    SplitSurface split;
    split.faces.resize(faces.size());
    split.source.resize(vertex_count);
    std::iota(split.source.begin(), split.source.end(), 0u);
    std::vector<std::uint8_t> taken(vertex_count, 0);
    for (std::uint32_t f = 0; f < faces.size(); ++f)
        for (std::uint32_t i = 0; i < 3; ++i) {
            // A set is represented by its smallest corner, which was numbered before all others.
            const std::uint32_t first = corners.find(3 * f + i), vertex = faces[f][i];
            if (first != 3 * f + i) {
                split.faces[f][i] = split.faces[first / 3][first % 3];
            } else if (!taken[vertex]) {
                taken[vertex] = 1;
                split.faces[f][i] = vertex;
            } else {
                split.faces[f][i] = static_cast<std::uint32_t>(split.source.size());
                split.source.push_back(vertex);
            }
        }
    return split;
}

SharpEdges find_sharp_edges(std::span<const Face> faces, std::span<const Vec3> vertices, float crease_angle) {
    SharpEdges edges{build_face_neighbors(faces, vertices), {}};
    mark_sharp_edges(faces, vertices, crease_angle, edges.neighbors);
    SplitSurface split = split_at_sharp_edges(faces, vertices.size(), edges.neighbors);
    if (split.source.size() > vertices.size()) edges.split = std::move(split);
    return edges;
}

}  // namespace exemplar
