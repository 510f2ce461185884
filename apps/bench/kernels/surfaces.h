#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "apps/bench/kernels/operation.h"
#include "gpu/runtime/record/buffer.h"
#include "host/animation/animation.h"
#include "host/core/random.h"
#include "host/mesh/curvature/curvature.h"
#include "shaders/shared/types.h"

/// The animated surface that kernels are measured on, and the comparison of their results.

namespace exemplar {

// Makes a wavy torus of twice as many faces as vertices. Its edges are about 1 long, so that rounding is about the
// same at all sizes.
inline TriangleMesh wavy_torus(std::uint32_t vertices) {
    const auto around = static_cast<std::uint32_t>(std::sqrt(vertices / 2.0)), along = vertices / around;
    TriangleMesh mesh;
    const auto at = [&](std::uint32_t i, std::uint32_t j) { return i % along * around + j % around; };
    const double ring = along / (2 * std::numbers::pi), tube = around / (2 * std::numbers::pi);
    for (std::uint32_t i = 0; i < along; ++i)
        for (std::uint32_t j = 0; j < around; ++j) {
            const double u = i / ring, v = j / tube, w = 2 * ring + tube * std::cos(v) * (1 + 0.1 * std::sin(5 * u));
            mesh.vertices.push_back(Vec3d(w * std::cos(u), w * std::sin(u), tube * std::sin(v)).cast<float>());
            mesh.faces.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            mesh.faces.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    return mesh;
}

// Makes a chain of 60 bones, four per vertex, and 20 morph targets that move a twentieth of the vertices each.
inline Rig chain_rig(std::size_t vertices, Random& random) {
    Rig rig;
    for (std::uint32_t b = 0; b < 60; ++b) {
        rig.nodes.push_back({std::to_string(b), b == 0 ? k_invalid_index : b - 1, {.translation = Vec3(0.1f, 0, 0)}});
        rig.bones.push_back({b, Affine::Identity()});
    }
    for (std::size_t v = 0; v < vertices; ++v) {
        rig.influence_begin.push_back(static_cast<std::uint32_t>(rig.influences.size()));
        const auto first = static_cast<std::uint32_t>(v * 57 / vertices);
        for (std::uint32_t b = first; b < first + 4; ++b) rig.influences.push_back({b, 0.25f});
    }
    rig.influence_begin.push_back(static_cast<std::uint32_t>(rig.influences.size()));
    for (std::size_t t = 0; t < 20; ++t) {
        MorphTarget target{.name = std::to_string(t), .vertices = {}, .offsets = {}};
        for (std::uint32_t v = 0; v < vertices; ++v)
            if (random.uniform() < 0.05) {
                target.vertices.push_back(v);
                target.offsets.emplace_back(0.1f, 0.2f, 0.3f);
            }
        rig.targets.push_back(std::move(target));
    }
    return rig;
}

inline std::vector<float> flattened(std::span<const Vec3> vectors, float scale) {
    std::vector<float> values;
    values.reserve(3 * vectors.size());
    for (const Vec3& v : vectors) values.insert(values.end(), {scale * v.x(), scale * v.y(), scale * v.z()});
    return values;
}

inline std::vector<shared::vec4> downloaded(const Buffer& buffer) {
    std::vector<shared::vec4> values(buffer.bytes() / sizeof(shared::vec4));
    buffer.download(std::span(values));
    return values;
}

inline std::vector<Vec3> vectors_of(const Buffer& buffer) {
    std::vector<Vec3> vectors;
    vectors.reserve(buffer.bytes() / sizeof(shared::vec4));
    for (const shared::vec4& v : downloaded(buffer)) vectors.emplace_back(v.x, v.y, v.z);
    return vectors;
}

inline Buffer uploaded(Device& device, std::span<const Vec3> vertices) {
    std::vector<shared::vec4> values;
    values.reserve(vertices.size());
    for (const Vec3& v : vertices) values.push_back({v.x(), v.y(), v.z(), 1.0f});
    return Buffer::of<shared::vec4>(device, values);
}

// Returns the second fundamental forms as matrices, row by row, which do not depend on the signs of principal
// directions.
inline std::vector<float> forms(const VertexCurvature& c) {
    std::vector<float> values;
    values.reserve(9 * c.k1.size());
    for (std::size_t v = 0; v < c.k1.size(); ++v) {
        const Eigen::Matrix3f form = c.k1[v] * c.e1[v] * c.e1[v].transpose() + c.k2[v] * c.e2[v] * c.e2[v].transpose();
        values.insert(values.end(), form.data(), form.data() + 9);
    }
    return values;
}

// Returns the squared sizes of the derivatives, which do not depend on the frame either.
inline std::vector<float> derivative_sizes(std::span<const std::array<float, 4>> derivatives) {
    std::vector<float> values;
    values.reserve(derivatives.size());
    for (const auto& d : derivatives) values.push_back(d[0] * d[0] + 3 * d[1] * d[1] + 3 * d[2] * d[2] + d[3] * d[3]);
    return values;
}

template <typename DeviceCurvature>
VertexCurvature downloaded(const DeviceCurvature& curvature) {
    VertexCurvature result;
    result.e1 = vectors_of(curvature.first());
    result.e2 = vectors_of(curvature.second());
    for (const shared::vec4& v : downloaded(curvature.first())) result.k1.push_back(v.w);
    for (const shared::vec4& v : downloaded(curvature.second())) result.k2.push_back(v.w);
    for (const shared::vec4& v : downloaded(curvature.derivative())) result.derivative.push_back({v.x, v.y, v.z, v.w});
    return result;
}

/// Compares curvature by absolute tolerances, as edges are about 1 long.
template <typename DeviceCurvature>
std::vector<Difference> differences_of(const DeviceCurvature& curvature, const VertexCurvature& expected) {
    const VertexCurvature actual = downloaded(curvature);
    return {{"curvature tensors", largest_difference(forms(actual), forms(expected)), 1e-5},
            {"sizes of derivatives",
             largest_difference(derivative_sizes(actual.derivative), derivative_sizes(expected.derivative)), 1e-5}};
}

}  // namespace exemplar
