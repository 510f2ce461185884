#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "host/core/parallel.h"
#include "host/shape/shape_families.h"

namespace exemplar {
namespace {

constexpr std::array<std::size_t, 5> k_ring_directions{4, 8, 8, 8, 4};
constexpr std::size_t k_directions = 32;

/// Returns directions spread evenly over the unit sphere: rings in bands whose areas are proportional to their
/// numbers of rays. With even numbers they equal their mirror image along every axis, so that the two sides of a
/// symmetric shape measure the same.
std::array<Vec3, k_directions> sphere_directions() {
    std::array<Vec3, k_directions> directions;
    double passed = 0.0;
    std::size_t next = 0;
    for (std::size_t ring = 0; ring < k_ring_directions.size(); ++ring) {
        const auto count = static_cast<double>(k_ring_directions[ring]);
        const double z = 1.0 - (2.0 * passed + count) / static_cast<double>(k_directions),
                     side = std::sqrt(1.0 - z * z);
        for (std::size_t k = 0; k < k_ring_directions[ring]; ++k) {
            const double turn =
                2.0 * std::numbers::pi * (static_cast<double>(k) + 0.5 * static_cast<double>(ring % 2)) / count;
            directions[next++] = Vec3d(side * std::cos(turn), side * std::sin(turn), z).cast<float>();
        }
        passed += count;
    }
    return directions;
}

/// Returns the radius of the largest sphere inside the mesh that touches the face at its center, estimated from the
/// rays of one cone: a sphere through the end of a ray of length d at angle t from the inward normal has radius d /
/// (2 cos t). Infinity if no ray counts.
float inscribed_radius(std::span<const float> length, std::span<const float> angle) {
    float radius = std::numeric_limits<float>::infinity();
    for (std::size_t k = 0; k < length.size(); ++k) {
        if (length[k] != k_missed) radius = std::min(radius, length[k] / (2.0F * std::cos(angle[k])));
    }
    return radius;
}

/// Returns statistics of the rays from the sphere's center to the surface around it. All rays have the same weight,
/// as they are spread evenly.
std::optional<RayStatistics> measure_around(const PreparedMesh& prepared, const RayScene& scene, std::size_t face,
                                            float radius) {
    static const std::array<Vec3, k_directions> directions = sphere_directions();
    static const std::vector<float> weight(k_directions, 1.0F);
    const Vec3& normal = prepared.normal[face];
    const Vec3 x = face_tangent(prepared, face), y = normal.cross(x), origin = prepared.center[face] - radius * normal;
    std::array<float, k_directions> length;
    for (std::size_t k = 0; k < k_directions; ++k) {
        const Vec3 direction =
            (directions[k].x() * x + directions[k].y() * y + directions[k].z() * normal).normalized();
        const auto hit = scene.first_hit(origin, direction, 0.0F);
        // Inside the mesh a ray meets surfaces from behind; one met from its front is a stray part or a hole's far
        // side.
        const bool counts = hit && std::isfinite(hit->distance) && prepared.normal[hit->face].dot(direction) > 0.0F;
        length[k] = counts ? hit->distance : k_missed;
    }
    return ray_statistics(length, weight);
}

}  // namespace

/// A cone without valid rays takes, as for the shape diameter, the values of the next wider cone that has one.
FeatureMatrix medial_features(const PreparedMesh& prepared, const RayScene& scene, const InwardRays& rays) {
    const InwardRayPattern& pattern = inward_ray_pattern();
    ConeStatistics statistics(prepared.face_count());
    const auto measure = [&](std::size_t f) {
        float measured = std::numeric_limits<float>::infinity();
        for (std::size_t cone = k_cones; cone-- > 0;) {
            const std::size_t count = pattern.cone_end[cone];
            const float radius = inscribed_radius(rays.of_face(f).first(count), std::span(pattern.angle).first(count));
            if (std::isfinite(radius) && radius != measured) {
                statistics[f][cone] = measure_around(prepared, scene, f, radius);
                measured = radius;
            } else if (cone + 1 < k_cones) {  // narrower cones often find the same sphere, or no ray counts in them
                statistics[f][cone] = statistics[f][cone + 1];
            }
        }
    };
    parallel_for(prepared.face_count(), measure, 64);
    return cone_features(prepared, "medial", statistics);
}

}  // namespace exemplar
