#include "host/parts/prototype/solid_distance.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "host/core/parallel.h"
#include "host/mesh/queries/rays.h"

namespace exemplar {
namespace {

/// The nearest point of a segment.
Vec3 nearest_on_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
    const Vec3 ab = b - a;
    const float length = ab.squaredNorm();
    return length > 0 ? Vec3(a + std::clamp((p - a).dot(ab) / length, 0.0F, 1.0F) * ab) : a;
}

float triangle_distance(const Vec3& p, const std::array<Vec3, 3>& t) {
    const Vec3 normal = (t[1] - t[0]).cross(t[2] - t[0]);
    bool is_over = normal.squaredNorm() > 0;
    for (std::size_t i = 0; i < 3 && is_over; ++i) is_over = (t[(i + 1) % 3] - t[i]).cross(p - t[i]).dot(normal) >= 0;
    if (is_over) return std::abs((p - t[0]).dot(normal)) / normal.norm();
    float nearest = std::numeric_limits<float>::infinity();
    for (std::size_t i = 0; i < 3; ++i)
        nearest = std::min(nearest, (p - nearest_on_segment(p, t[i], t[(i + 1) % 3])).norm());
    return nearest;
}

/// The sum of entering minus leaving faces before each of `count` nodes along a line.
std::vector<int> winding_along(const RayScene& scene, const std::vector<Vec3>& normals, const Vec3& first,
                               const Vec3& direction, float cell, std::uint32_t count) {
    std::vector<int> winding(count, 0);
    const float before = cell;  // the line begins outside
    float near = 0;
    const Vec3 begin = first - before * direction;
    while (const auto hit = scene.first_hit(begin, direction, near)) {
        const auto node = static_cast<std::int64_t>(std::ceil((hit->distance - before) / cell));
        const int step = normals[hit->face].dot(direction) < 0 ? 1 : -1;
        for (std::int64_t i = std::max<std::int64_t>(node, 0); i < std::int64_t{count}; ++i)
            winding[static_cast<std::size_t>(i)] += step;
        near = std::max(near, hit->distance) + 1e-3F * cell;  // an edge is hit once
    }
    return winding;
}

}  // namespace

SurfaceDistance::SurfaceDistance(const TriangleMesh& mesh, const std::vector<std::uint32_t>& faces, float spacing)
    : mesh_(&mesh) {
    std::vector<Vec3> samples;
    for (const std::uint32_t f : faces) {
        const Vec3 &a = mesh.vertices[mesh.faces[f][0]], &b = mesh.vertices[mesh.faces[f][1]],
                   &c = mesh.vertices[mesh.faces[f][2]];
        const float longest = std::max({(a - b).norm(), (b - c).norm(), (c - a).norm()});
        const int n = std::clamp(static_cast<int>(std::ceil(longest / spacing)), 1, 256);
        for (int i = 0; i < n; ++i)
            for (int j = 0; j + i < n; ++j) {
                const float u = (static_cast<float>(i) + 1.0F / 3) / static_cast<float>(n),
                            v = (static_cast<float>(j) + 1.0F / 3) / static_cast<float>(n);
                samples.push_back(a + u * (b - a) + v * (c - a));
                face_of_sample_.push_back(f);
            }
    }
    tree_ = std::make_unique<PointTree>(std::move(samples));
}

float SurfaceDistance::operator()(const Vec3& point) const {
    std::array<std::uint32_t, 4> found{};
    const std::size_t count = tree_->nearest(point, found);
    float nearest = std::numeric_limits<float>::infinity();
    for (std::size_t i = 0; i < count; ++i) {
        const Face& face = mesh_->faces[face_of_sample_[found[i]]];
        nearest = std::min(nearest, triangle_distance(point, {mesh_->vertices[face[0]], mesh_->vertices[face[1]],
                                                              mesh_->vertices[face[2]]}));
    }
    return nearest;
}

std::vector<bool> nodes_inside(const TriangleMesh& mesh, const std::array<std::uint32_t, 3>& size, const Vec3& origin,
                               float cell) {
    const RayScene scene(mesh);
    const std::vector<Vec3> normals = face_normals(mesh);
    std::vector<std::uint8_t> votes(std::size_t{size[0]} * size[1] * size[2], 0);
    const std::array<std::size_t, 3> stride{1, size[0], std::size_t{size[0]} * size[1]};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
        const Vec3 direction = Vec3::Unit(static_cast<Eigen::Index>(axis));
        parallel_for(
            std::size_t{size[u]} * size[v],
            [&](std::size_t line) {
                const std::size_t i = line % size[u], j = line / size[u];
                Vec3 first = origin;
                first[static_cast<Eigen::Index>(u)] += cell * static_cast<float>(i);
                first[static_cast<Eigen::Index>(v)] += cell * static_cast<float>(j);
                const std::vector<int> winding = winding_along(scene, normals, first, direction, cell, size[axis]);
                for (std::size_t k = 0; k < winding.size(); ++k)
                    votes[i * stride[u] + j * stride[v] + k * stride[axis]] += winding[k] > 0;
            },
            16);
    }
    std::vector<bool> inside(votes.size());
    for (std::size_t n = 0; n < votes.size(); ++n) inside[n] = votes[n] >= 2;
    return inside;
}

}  // namespace exemplar
