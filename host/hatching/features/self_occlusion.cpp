#include "host/hatching/features/self_occlusion.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/core/parallel.h"
#include "host/mesh/queries/rays.h"
#include "host/mesh/vertex_neighbors.h"

namespace exemplar {
namespace {

/// Mean length of the edges at each vertex.
std::vector<float> edge_lengths(const TriangleMesh& mesh) {
    const VertexNeighbors neighbors = build_vertex_neighbors(mesh.faces, mesh.vertex_count());
    std::vector<float> length(mesh.vertex_count());
    for (std::size_t v = 0; v < length.size(); ++v) {
        for (const std::uint32_t near : neighbors.of(v)) length[v] += (mesh.vertices[near] - mesh.vertices[v]).norm();
        length[v] /= static_cast<float>(std::max<std::size_t>(neighbors.of(v).size(), 1));
    }
    return length;
}

/// Sampling directions and their harmonics. They are the same for all vertices, so that results differ only by the
/// surface.
struct Sky {
    std::vector<Vec3> direction;
    std::vector<Harmonics> harmonics;
    explicit Sky(std::size_t count) : direction(sphere_directions(count)) {
        for (const Vec3& way : direction) harmonics.push_back(spherical_harmonics(way));
    }
};

}  // namespace

SelfOcclusion measure_self_occlusion(const TriangleMesh& mesh, std::span<const Vec3> normals, std::size_t rays) {
    const Sky sky(rays);
    const RayScene scene(mesh);
    const std::vector<float> edge = edge_lengths(mesh);
    SelfOcclusion out{std::vector<float>(mesh.vertex_count()), std::vector<Harmonics>(mesh.vertex_count()),
                      std::vector<Harmonics>(mesh.vertex_count())};
    const float share = 4 * std::numbers::pi_v<float> / static_cast<float>(rays);
    const auto measure = [&](std::size_t v) {
        // Rays start a little above the surface, so that grazing rays do not hit the faces around the vertex.
        const Vec3 origin = mesh.vertices[v] + 0.02f * edge[v] * normals[v];
        float open = 0, all = 0;
        for (std::size_t k = 0; k < sky.direction.size(); ++k) {
            const float cosine = normals[v].dot(sky.direction[k]);
            if (!(cosine > 0)) continue;
            all += cosine;
            if (scene.first_hit(origin, sky.direction[k], 0)) continue;
            open += cosine;
            for (std::size_t i = 0; i < k_harmonics; ++i) {
                out.visibility[v][i] += share * sky.harmonics[k][i];
                out.transfer[v][i] += share / std::numbers::pi_v<float> * cosine * sky.harmonics[k][i];
            }
        }
        out.ambient[v] = all > 0 ? open / all : 0;
    };
    parallel_for(mesh.vertex_count(), measure, 64);
    return out;
}

std::vector<float> shade(const SelfOcclusion& occlusion, const Vec3& light) {
    Harmonics coefficients = distant_light(light);
    for (float& coefficient : coefficients) coefficient *= std::numbers::pi_v<float>;
    std::vector<float> bright(occlusion.transfer.size());
    for (std::size_t v = 0; v < bright.size(); ++v)
        bright[v] = std::clamp(dot(coefficients, occlusion.transfer[v]), 0.0f, 1.0f);
    return bright;
}

std::vector<Vec3> vector_irradiance(const SelfOcclusion& occlusion, const Vec3& light) {
    const Harmonics coefficients = distant_light(light);
    constexpr std::size_t k_directions = 1024;
    const Sky sky(k_directions);
    // The light times the direction it comes from, as harmonics; negative light, where harmonics ring, counts as none.
    std::array<Harmonics, 3> moments{};
    for (std::size_t k = 0; k < k_directions; ++k) {
        const float radiance = std::max(dot(coefficients, sky.harmonics[k]), 0.0f) / static_cast<float>(k_directions);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const float moment = radiance * sky.direction[k][static_cast<Eigen::Index>(axis)];
            for (std::size_t i = 0; i < k_harmonics; ++i) moments[axis][i] += moment * sky.harmonics[k][i];
        }
    }
    std::vector<Vec3> irradiance;
    for (const Harmonics& visibility : occlusion.visibility)
        irradiance.emplace_back(dot(moments[0], visibility), dot(moments[1], visibility), dot(moments[2], visibility));
    return irradiance;
}

}  // namespace exemplar
