#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "host/core/random.h"
#include "host/mesh/mesh.h"

/// Triangle meshes of known shape for tests. All are oriented outward, without duplicate vertices, centered on the
/// origin unless said otherwise.
namespace exemplar::shapes {

namespace detail {

inline Vec3 vec3(double x, double y, double z) {
    return {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)};
}
inline std::uint32_t index_of(std::size_t value) {
    return static_cast<std::uint32_t>(value);
}

inline TriangleMesh finished(TriangleMesh mesh) {
    mesh.source_face_count = index_of(mesh.faces.size());
    return mesh;
}
/// Adds the quadrilateral a b c d (counter-clockwise) as two triangles.
inline void add_quad(TriangleMesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    mesh.faces.push_back({a, b, c});
    mesh.faces.push_back({a, c, d});
}
inline TriangleMesh icosahedron() {
    TriangleMesh mesh;
    const double g = std::numbers::phi;
    for (double a : {-1.0, 1.0})
        for (double b : {-g, g})
            for (int axis = 0; axis < 3; ++axis) {
                Vec3 p = Vec3::Zero();
                p[(axis + 1) % 3] = static_cast<float>(a);
                p[(axis + 2) % 3] = static_cast<float>(b);
                mesh.vertices.push_back(p);
            }
    for (std::uint32_t i = 0; i < 12; ++i)
        for (std::uint32_t j = i + 1; j < 12; ++j)
            for (std::uint32_t k = j + 1; k < 12; ++k) {
                const Vec3 &p = mesh.vertices[i], &q = mesh.vertices[j], &r = mesh.vertices[k];
                const float longest = std::max({(p - q).norm(), (q - r).norm(), (r - p).norm()});
                if (longest > 2.1f) continue;
                const bool outward = (q - p).cross(r - p).dot(p) > 0;
                mesh.faces.push_back(outward ? Face{i, j, k} : Face{i, k, j});
            }
    return mesh;
}

}  // namespace detail

/// A sphere of 20 * 4^subdivisions faces; its vertices lie exactly (to rounding) on the sphere.
inline TriangleMesh icosphere(int subdivisions, float radius) {
    TriangleMesh mesh = detail::icosahedron();
    for (int level = 0; level < subdivisions; ++level) {
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> midpoints;
        const auto midpoint = [&](std::uint32_t a, std::uint32_t b) {
            const auto [it, added] =
                midpoints.try_emplace({std::min(a, b), std::max(a, b)}, detail::index_of(mesh.vertices.size()));
            if (added) mesh.vertices.push_back((mesh.vertices[a].normalized() + mesh.vertices[b].normalized()) * 0.5f);
            return it->second;
        };
        std::vector<Face> finer;
        for (const auto& [a, b, c] : mesh.faces) {
            const std::uint32_t ab = midpoint(a, b), bc = midpoint(b, c), ca = midpoint(c, a);
            for (const Face& f : {Face{a, ab, ca}, Face{ab, b, bc}, Face{ca, bc, c}, Face{ab, bc, ca}})
                finer.push_back(f);
        }
        mesh.faces = std::move(finer);
    }
    for (Vec3& p : mesh.vertices) p = (p.cast<double>().normalized() * static_cast<double>(radius)).cast<float>();
    return detail::finished(std::move(mesh));
}

/// A torus around z: a tube around a circle, of these radii; n quads along the circle, m around the tube.
inline TriangleMesh torus(float ring, float tube, std::uint32_t n, std::uint32_t m) {
    TriangleMesh mesh;
    for (std::uint32_t i = 0; i < n; ++i)
        for (std::uint32_t j = 0; j < m; ++j) {
            const double u = 2 * std::numbers::pi * i / n, v = 2 * std::numbers::pi * j / m;
            const double w = ring + tube * std::cos(v);
            mesh.vertices.push_back(detail::vec3(w * std::cos(u), w * std::sin(u), tube * std::sin(v)));
            const auto at = [&](std::uint32_t a, std::uint32_t b) { return (a % n) * m + b % m; };
            detail::add_quad(mesh, at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
        }
    return detail::finished(std::move(mesh));
}

/// The square [0, size] x [0, size] in the plane z = 0, normals +z, of nx x ny quads.
inline TriangleMesh grid(std::uint32_t nx, std::uint32_t ny, float size) {
    TriangleMesh mesh;
    for (std::uint32_t j = 0; j <= ny; ++j)
        for (std::uint32_t i = 0; i <= nx; ++i) {
            const double s = size;
            mesh.vertices.push_back(detail::vec3(s * i / nx, s * j / ny, 0));
        }
    const auto at = [&](std::uint32_t i, std::uint32_t j) { return j * (nx + 1) + i; };
    for (std::uint32_t j = 0; j < ny; ++j)
        for (std::uint32_t i = 0; i < nx; ++i)
            detail::add_quad(mesh, at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
    return detail::finished(std::move(mesh));
}

/// A cylinder along z, |z| <= height / 2, of n quads around and m along; caps are fans around a center vertex.
inline TriangleMesh cylinder(float radius, float height, std::uint32_t n, std::uint32_t m, bool capped) {
    TriangleMesh mesh;
    for (std::uint32_t j = 0; j <= m; ++j)
        for (std::uint32_t i = 0; i < n; ++i) {
            const double u = 2 * std::numbers::pi * i / n, r = radius, h = height;
            mesh.vertices.push_back(detail::vec3(r * std::cos(u), r * std::sin(u), h * j / m - h / 2));
        }
    const auto at = [&](std::uint32_t i, std::uint32_t j) { return j * n + i % n; };
    for (std::uint32_t j = 0; j < m; ++j)
        for (std::uint32_t i = 0; i < n; ++i)
            detail::add_quad(mesh, at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
    if (capped) {
        const std::uint32_t bottom = detail::index_of(mesh.vertices.size()), top = bottom + 1;
        mesh.vertices.push_back({0, 0, -height / 2});
        mesh.vertices.push_back({0, 0, height / 2});
        for (std::uint32_t i = 0; i < n; ++i) {
            mesh.faces.push_back({bottom, at(i + 1, 0), at(i, 0)});
            mesh.faces.push_back({top, at(i, m), at(i + 1, m)});
        }
    }
    return detail::finished(std::move(mesh));
}

/// A closed box with the given side lengths, n x n quads a side.
inline TriangleMesh box(float sx, float sy, float sz, std::uint32_t n) {
    TriangleMesh mesh;
    std::map<std::array<std::uint32_t, 3>, std::uint32_t> index;
    const auto at = [&](const std::array<std::uint32_t, 3>& p) {
        const auto [it, added] = index.try_emplace(p, detail::index_of(mesh.vertices.size()));
        const auto coordinate = [&](float side, std::uint32_t i) { return side * (double(i) / n - 0.5); };
        if (added)
            mesh.vertices.push_back(detail::vec3(coordinate(sx, p[0]), coordinate(sy, p[1]), coordinate(sz, p[2])));
        return it->second;
    };
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (std::uint32_t side : {0u, n})
            for (std::uint32_t i = 0; i < n; ++i)
                for (std::uint32_t j = 0; j < n; ++j) {
                    const auto corner = [&](std::uint32_t a, std::uint32_t b) {
                        std::array<std::uint32_t, 3> p{};
                        p[axis] = side;
                        p[(axis + 1) % 3] = i + a;
                        p[(axis + 2) % 3] = j + b;
                        return at(p);
                    };
                    const std::uint32_t a = corner(0, 0), b = corner(1, 0), c = corner(1, 1), d = corner(0, 1);
                    if (side == n)
                        detail::add_quad(mesh, a, b, c, d);
                    else
                        detail::add_quad(mesh, a, d, c, b);
                }
    return detail::finished(std::move(mesh));
}

/// The mesh with every vertex replaced by map(vertex).
template <typename Map>
TriangleMesh transformed(TriangleMesh mesh, Map&& map) {
    for (Vec3& p : mesh.vertices) p = map(p);
    return mesh;
}
inline TriangleMesh rotated(TriangleMesh mesh, const Eigen::Matrix3f& rotation) {
    return transformed(std::move(mesh), [&](const Vec3& p) -> Vec3 { return rotation * p; });
}
inline TriangleMesh translated(TriangleMesh mesh, const Vec3& offset) {
    return transformed(std::move(mesh), [&](const Vec3& p) -> Vec3 { return p + offset; });
}
inline TriangleMesh scaled(TriangleMesh mesh, float factor) {
    return transformed(std::move(mesh), [&](const Vec3& p) -> Vec3 { return p * factor; });
}
/// Both meshes side by side in one, sharing nothing.
inline TriangleMesh joined(TriangleMesh first, const TriangleMesh& second) {
    const std::uint32_t offset = detail::index_of(first.vertices.size());
    first.vertices.insert(first.vertices.end(), second.vertices.begin(), second.vertices.end());
    for (const auto& [a, b, c] : second.faces) first.faces.push_back({a + offset, b + offset, c + offset});
    return detail::finished(std::move(first));
}
/// The mesh with its faces in another order: face i of the result is face permutation[i] of `mesh`.
inline TriangleMesh with_shuffled_faces(const TriangleMesh& mesh, std::uint64_t seed,
                                        std::vector<std::uint32_t>* permutation = nullptr) {
    std::vector<std::uint32_t> order(mesh.faces.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = detail::index_of(i);
    Random(seed).shuffle(order);
    TriangleMesh result = mesh;
    for (std::size_t i = 0; i < order.size(); ++i) {
        result.faces[i] = mesh.faces[order[i]];
        if (!mesh.source_face.empty()) result.source_face[i] = mesh.source_face[order[i]];
    }
    if (permutation) *permutation = std::move(order);
    return result;
}
/// A uniformly distributed rotation.
inline Eigen::Matrix3f random_rotation(std::uint64_t seed) {
    Random random(seed);
    Eigen::Vector3d a, b;
    for (int i = 0; i < 3; ++i) a[i] = random.normal();
    for (int i = 0; i < 3; ++i) b[i] = random.normal();
    Eigen::Matrix3d rotation;
    rotation.col(0) = a.normalized();
    rotation.col(1) = (b - b.dot(rotation.col(0)) * rotation.col(0)).normalized();
    rotation.col(2) = rotation.col(0).cross(rotation.col(1));
    return rotation.cast<float>();
}

}  // namespace exemplar::shapes
