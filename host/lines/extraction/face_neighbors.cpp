#include "host/lines/extraction/face_neighbors.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "host/core/errors.h"

namespace exemplar {

namespace {

/// A side of a face: the higher vertex of its edge, and its code (4 * face + side).
struct Side {
    std::uint32_t high, code;
    bool operator<(const Side& other) const { return high != other.high ? high < other.high : code < other.code; }
};

void check_faces(std::span<const Face> faces, std::size_t vertex_count) {
    if (faces.size() >= k_max_neighbor_code / 4)
        throw MeshError(fmt::format("{} faces are more than lines can be found on; simplify the mesh", faces.size()));
    for (std::size_t f = 0; f < faces.size(); ++f)
        for (const std::uint32_t v : faces[f])
            if (v >= vertex_count)
                throw MeshError(fmt::format("face {} names vertex {}, but there are {}", f, v, vertex_count));
}

/// Returns the two of the sides of one edge, three or more, that the widest empty angle around it is between.
std::pair<Side, Side> outermost(std::span<const Side> sides, std::span<const Face> faces,
                                std::span<const Vec3> vertices) {
    const auto corner = [&](const Side& side, std::uint32_t i) -> const Vec3& {
        return vertices[faces[side.code / 4][(side.code % 4 + i) % 3]];
    };
    const Vec3d origin = corner(sides[0], 0).cast<double>();
    const Vec3d axis = (corner(sides[0], 1).cast<double>() - origin).stableNormalized();
    const Vec3d first = axis.unitOrthogonal(), second = axis.cross(first);
    std::vector<std::pair<double, std::size_t>> angles;
    for (std::size_t i = 0; i < sides.size(); ++i) {
        const Vec3d way = corner(sides[i], 2).cast<double>() - origin;
        angles.emplace_back(std::atan2(second.dot(way), first.dot(way)), i);
    }
    std::sort(angles.begin(), angles.end());
    std::size_t best = angles.size() - 1;
    double widest = angles.front().first + 2 * std::numbers::pi - angles.back().first;
    for (std::size_t i = 0; i + 1 < angles.size(); ++i)
        if (const double gap = angles[i + 1].first - angles[i].first; gap > widest) {
            widest = gap;
            best = i;
        }
    return {sides[angles[best].second], sides[angles[(best + 1) % angles.size()].second]};
}

}  // namespace

std::vector<FaceNeighbors> build_face_neighbors(std::span<const Face> faces, std::span<const Vec3> vertices) {
    const std::size_t vertex_count = vertices.size();
    check_faces(faces, vertex_count);
    // All sides, grouped by the lower vertex of their edge.
    std::vector<std::uint32_t> begin(vertex_count + 1, 0);
    const auto for_each_side = [&](auto&& use) {
        for (std::uint32_t f = 0; f < faces.size(); ++f)
            for (std::uint32_t i = 0; i < 3; ++i) {
                const auto [low, high] = std::minmax(faces[f][i], faces[f][(i + 1) % 3]);
                if (low != high) use(low, Side{high, 4 * f + i});
            }
    };
    for_each_side([&](std::uint32_t low, const Side&) { ++begin[low + 1]; });
    for (std::size_t v = 0; v < vertex_count; ++v) begin[v + 1] += begin[v];
    std::vector<Side> sides(begin.back());
    std::vector<std::uint32_t> next(begin.begin(), begin.end() - 1);
    for_each_side([&](std::uint32_t low, const Side& side) { sides[next[low]++] = side; });

    std::vector<FaceNeighbors> neighbors(faces.size(), {k_blocked_side, k_blocked_side, k_blocked_side});
    const auto set = [&](const Side& side, std::uint32_t to) { neighbors[side.code / 4][side.code % 4] = to; };
    const auto join = [&](const Side& a, const Side& b, std::uint32_t flags) {
        set(a, b.code | flags);
        set(b, a.code | flags);
    };
    for (std::size_t v = 0; v < vertex_count; ++v) {
        std::sort(sides.begin() + begin[v], sides.begin() + begin[v + 1]);
        for (std::uint32_t first = begin[v], last = first; first < begin[v + 1]; first = last) {
            while (last < begin[v + 1] && sides[last].high == sides[first].high) ++last;
            if (last - first == 1) set(sides[first], k_no_neighbor);
            if (last - first == 2) join(sides[first], sides[first + 1], 0);
            if (last - first <= 2) continue;
            const auto [a, b] = outermost(std::span(sides).subspan(first, last - first), faces, vertices);
            join(a, b, k_sharp_side | k_crowded_side);
        }
    }
    return neighbors;
}

}  // namespace exemplar
