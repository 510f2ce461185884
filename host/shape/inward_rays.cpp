#include "host/shape/inward_rays.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/core/parallel.h"
#include "host/core/statistics.h"
#include "host/shape/percentile.h"

namespace exemplar {
namespace {

InwardRayPattern make_pattern() {
    constexpr std::array<std::size_t, 8> k_ring_rays{4, 6, 8, 10, 12, 12, 14, 14};
    constexpr double k_step = 7.5 * std::numbers::pi / 180.0;
    InwardRayPattern pattern{};
    pattern.weight[0] = static_cast<float>(2.0 / k_step);  // the mean angle of its part of the cone is half a step
    std::size_t ray = 1;
    for (std::size_t ring = 0; ring < k_ring_rays.size(); ++ring) {
        const double angle = k_step * static_cast<double>(ring + 1);
        for (std::size_t k = 0; k < k_ring_rays[ring]; ++k, ++ray) {
            const double turn =
                (static_cast<double>(k) + 0.5 * static_cast<double>(ring % 2)) / static_cast<double>(k_ring_rays[ring]);
            pattern.angle[ray] = static_cast<float>(angle);
            pattern.azimuth[ray] = static_cast<float>(2.0 * std::numbers::pi * turn);
            pattern.weight[ray] = static_cast<float>(1.0 / angle);
        }
        if (ring % 2 == 1) pattern.cone_end[ring / 2] = ray;
    }
    return pattern;
}

/// Length of one ray, or k_missed.
float cast_ray(const PreparedMesh& prepared, const RayScene& scene, std::uint32_t face, const Vec3& direction) {
    // Rays to walls at a right angle count: rounding must not switch them on and off.
    constexpr float k_same_way = 0.1F;
    const auto hit = scene.first_hit_from(face, prepared.center[face], direction);
    if (!hit || prepared.normal[hit->face].dot(prepared.normal[face]) > k_same_way) return k_missed;
    return std::isfinite(hit->distance) ? std::max(hit->distance, 0.0F) : k_missed;
}

/// Fills in faces without a value, then clips and divides: values are in [0, 1].
void normalize_values(const PreparedMesh& prepared, const std::vector<bool>& known, std::span<float> values) {
    std::vector<std::pair<float, float>> pairs;
    for (std::size_t f = 0; f < values.size(); ++f) {
        if (known[f]) pairs.emplace_back(values[f], prepared.area_share[f]);
    }
    const float top = weighted_percentile(pairs, 0.95), middle = weighted_percentile(pairs, 0.5);
    for (std::size_t f = 0; f < values.size(); ++f) {
        const float value = known[f] ? values[f] : middle;
        values[f] = top > 0.0F ? std::min(value / top, 1.0F) : 0.0F;
    }
}

}  // namespace

const InwardRayPattern& inward_ray_pattern() {
    static const InwardRayPattern pattern = make_pattern();
    return pattern;
}

InwardRays cast_inward_rays(const PreparedMesh& prepared, const RayScene& scene) {
    const InwardRayPattern& pattern = inward_ray_pattern();
    std::array<Vec3, InwardRayPattern::k_rays> local;
    for (std::size_t k = 0; k < local.size(); ++k) {
        const float side = std::sin(pattern.angle[k]);
        local[k] = {side * std::cos(pattern.azimuth[k]), side * std::sin(pattern.azimuth[k]),
                    std::cos(pattern.angle[k])};
    }
    InwardRays rays;
    rays.length.resize(prepared.face_count() * local.size());
    parallel_for(
        prepared.face_count(),
        [&](std::size_t f) {
            const Vec3 inward = -prepared.normal[f], x = face_tangent(prepared, f), y = prepared.normal[f].cross(x);
            for (std::size_t k = 0; k < local.size(); ++k) {
                const Vec3 direction = (local[k].x() * x + local[k].y() * y + local[k].z() * inward).normalized();
                rays.length[f * local.size() + k] = cast_ray(prepared, scene, static_cast<std::uint32_t>(f), direction);
            }
        },
        64);
    return rays;
}

std::optional<RayStatistics> ray_statistics(std::span<const float> length, std::span<const float> weight) {
    std::array<float, InwardRayPattern::k_rays> kept;
    std::size_t count = 0;
    double sum = 0.0, squares = 0.0;
    for (const float d : length) {
        if (d == k_missed) continue;
        kept[count++] = d;
        sum += static_cast<double>(d);
        squares += static_cast<double>(d) * static_cast<double>(d);
    }
    if (count == 0) return std::nullopt;
    const double n = static_cast<double>(count), middle = static_cast<double>(median(std::span(kept).first(count)));
    const double deviation = std::sqrt(std::max(0.0, squares / n - sum * sum / (n * n)));
    const double reach = 1.0001 * deviation + 1e-4 * middle;  // rounding must not exclude equal lengths

    double total = 0.0, mean = 0.0, mean_square = 0.0;
    for (std::size_t k = 0; k < length.size(); ++k) {
        const double d = static_cast<double>(length[k]), w = static_cast<double>(weight[k]);
        if (length[k] == k_missed || std::abs(d - middle) > reach) continue;
        total += w;
        mean += w * d;
        mean_square += w * d * d;
    }
    return RayStatistics{static_cast<float>(mean / total), static_cast<float>(middle),
                         static_cast<float>(mean_square / total)};
}

FeatureMatrix cone_features(const PreparedMesh& prepared, const std::string& family, const ConeStatistics& statistics) {
    constexpr std::array<float RayStatistics::*, 3> k_fields{&RayStatistics::mean, &RayStatistics::median,
                                                             &RayStatistics::mean_square};
    const std::array<std::string, 3> names{"mean", "median", "mean_square"};
    constexpr std::array<int, 4> k_alphas{1, 2, 4, 8};
    FeatureMatrix matrix;
    matrix.rows = prepared.face_count();
    std::vector<bool> known(matrix.rows);
    std::vector<float> values(matrix.rows);
    for (std::size_t cone = 0; cone < k_cones; ++cone) {
        for (std::size_t field = 0; field < k_fields.size(); ++field) {
            for (std::size_t f = 0; f < matrix.rows; ++f) {
                const auto& of_face = statistics[f][cone];
                known[f] = of_face.has_value();
                values[f] = of_face ? (*of_face).*k_fields[field] : 0.0F;
            }
            normalize_values(prepared, known, values);
            const std::string name = family + "." + names[field] + "@" + std::to_string(k_cone_angles[cone]);
            std::ranges::copy(values, matrix.add(name).begin());
            for (const int alpha : k_alphas) {
                const auto a = static_cast<float>(alpha);
                std::ranges::transform(values, matrix.add(name + "/log" + std::to_string(alpha)).begin(),
                                       [a](float x) { return std::log(a * x + 1.0F) / std::log(a + 1.0F); });
            }
        }
    }
    return matrix;
}

}  // namespace exemplar
