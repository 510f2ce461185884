#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "gpu/runtime/record/buffer.h"
#include "host/animation/animation.h"
#include "host/core/random.h"
#include "shaders/shared/types.h"
#include "tests/support/shapes.h"

/// Rigs and deforming surfaces for the parity tests of the device's curvature.
namespace exemplar::test_support {

inline Vec3 random_vec3(Random& random) {
    return {static_cast<float>(random.normal()), static_cast<float>(random.normal()),
            static_cast<float>(random.normal())};
}

inline NodeTransform random_transform(Random& random) {
    Eigen::Quaternionf rotation(static_cast<float>(random.normal()), static_cast<float>(random.normal()),
                                static_cast<float>(random.normal()), static_cast<float>(random.normal()));
    return {.translation = random_vec3(random),
            .rotation = rotation.normalized(),
            .scale = Vec3::Ones() + 0.1f * random_vec3(random)};
}

/// One to six influences per vertex, by rising bone and with weights that sum to one.
inline void add_influences(Rig& rig, std::size_t vertices, Random& random) {
    rig.influence_begin = {0};
    for (std::size_t v = 0; v < vertices; ++v) {
        const std::size_t count = std::min(1 + random.index(6), rig.bones.size());
        std::vector<std::uint32_t> bones(rig.bones.size());
        for (std::uint32_t b = 0; b < bones.size(); ++b) bones[b] = b;
        random.shuffle(bones);
        std::sort(bones.begin(), bones.begin() + static_cast<std::ptrdiff_t>(count));
        std::vector<double> weights;
        double sum = 0;
        for (std::size_t i = 0; i < count; ++i) sum += weights.emplace_back(random.uniform(0.05, 1.0));
        for (std::size_t i = 0; i < count; ++i)
            rig.influences.push_back({bones[i], static_cast<float>(weights[i] / sum)});
        rig.influence_begin.push_back(static_cast<std::uint32_t>(rig.influences.size()));
    }
}

/// A chain of bones with branches, and targets that each move a tenth of the vertices.
inline Rig random_rig(std::size_t vertices, std::size_t bones, std::size_t targets, Random& random) {
    Rig rig;
    for (std::uint32_t i = 0; i < bones; ++i) {
        const std::uint32_t parent = i == 0 ? k_invalid_index : static_cast<std::uint32_t>(random.index(i));
        rig.nodes.push_back({"node" + std::to_string(i), parent, random_transform(random)});
        Affine inverse = Affine::Identity();
        inverse.translation() = random_vec3(random);
        rig.bones.push_back({i, inverse});
    }
    add_influences(rig, vertices, random);
    for (std::size_t t = 0; t < targets; ++t) {
        MorphTarget target{.name = "target" + std::to_string(t), .vertices = {}, .offsets = {}};
        for (std::uint32_t v = 0; v < vertices; ++v)
            if (random.uniform() < 0.1) {
                target.vertices.push_back(v);
                target.offsets.push_back(random_vec3(random));
            }
        rig.targets.push_back(target);
    }
    return rig;
}

inline Pose random_pose(const Rig& rig, Random& random) {
    Pose pose;
    for (std::size_t i = 0; i < rig.nodes.size(); ++i) pose.nodes.push_back(random_transform(random));
    for (std::size_t t = 0; t < rig.targets.size(); ++t)
        pose.weights.push_back(random.uniform() < 0.3 ? 0.0f : static_cast<float>(random.uniform()));
    return pose;
}

/// A strip of triangles of any number of vertices, bent and twisted in space; all its vertices are on its boundary.
inline TriangleMesh strip(std::size_t vertices) {
    TriangleMesh mesh;
    for (std::size_t i = 0; i < vertices; ++i) {
        const float along = 0.5f * static_cast<float>(i), side = i % 2 == 0 ? -0.5f : 0.5f;
        const float tilt = 0.3f * std::sin(0.2f * along);
        mesh.vertices.push_back({5 * std::sin(0.1f * along), 5 * std::cos(0.1f * along) + side * std::sin(tilt),
                                 side * std::cos(tilt) + 0.2f * std::sin(0.7f * along)});
    }
    for (std::uint32_t i = 0; i + 2 < vertices; ++i)
        mesh.faces.push_back(i % 2 == 0 ? Face{i, i + 1, i + 2} : Face{i + 1, i, i + 2});
    return shapes::detail::finished(std::move(mesh));
}

/// `mesh` with smooth waves of the given height along its points, which leave no symmetry.
inline TriangleMesh waved(TriangleMesh mesh, float height) {
    return shapes::transformed(std::move(mesh), [&](const Vec3& p) -> Vec3 {
        const Vec3 wave(std::sin(2.1f * p.y() + 0.3f), std::sin(1.7f * p.z() + 1.1f), std::sin(2.3f * p.x() + 2.0f));
        return p + height * wave;
    });
}

/// A buffer of vec4s (x, y, z, 1), as the kernels take vertices.
inline Buffer upload_vertices(Device& device, const std::vector<Vec3>& vertices) {
    std::vector<shared::vec4> out;
    out.reserve(vertices.size());
    for (const Vec3& v : vertices) out.push_back({v.x(), v.y(), v.z(), 1.0f});
    return Buffer::of<shared::vec4>(device, out);
}

inline std::vector<shared::vec4> download(const Buffer& buffer) {
    std::vector<shared::vec4> values(buffer.bytes() / sizeof(shared::vec4));
    buffer.download(std::span(values));
    return values;
}

inline Vec3 xyz(const shared::vec4& v) {
    return {v.x, v.y, v.z};
}

}  // namespace exemplar::test_support
