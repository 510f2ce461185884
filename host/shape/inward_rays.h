#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "host/learn/feature_matrix.h"
#include "host/mesh/queries/rays.h"
#include "host/shape/prepared_mesh.h"

namespace exemplar {

constexpr std::array<int, 4> k_cone_angles{30, 60, 90, 120};  ///< opening angles in degrees (thesis App. A.1c)
constexpr std::size_t k_cones = k_cone_angles.size();
constexpr float k_missed = -1.0F;  ///< length of a ray that left the mesh or hit the surface from outside

/// The directions of a face's rays: one along the inward normal and rings around it every 7.5 degrees up to 60. The
/// rays of cone c are the first cone_end[c].
struct InwardRayPattern {
    static constexpr std::size_t k_rays = 81;
    std::array<float, k_rays> angle;    ///< from the inward normal, radians
    std::array<float, k_rays> azimuth;  ///< from the face's tangent, radians
    std::array<float, k_rays> weight;   ///< inverse of the angle (Shapira et al. 2008), bounded at the center
    std::array<std::size_t, k_cones> cone_end;
};
const InwardRayPattern& inward_ray_pattern();

/// Lengths of all rays, cast inward from each face's center: faces x k_rays; k_missed where there is no hit.
/// Rays that hit a face whose normal points the same way as the source's are dropped (Shapira et al. 2008).
struct InwardRays {
    std::vector<float> length;
    std::span<const float> of_face(std::size_t face) const {
        return {length.data() + face * InwardRayPattern::k_rays, InwardRayPattern::k_rays};
    }
};
InwardRays cast_inward_rays(const PreparedMesh& prepared, const RayScene& scene);

/// Statistics of the ray lengths in a cone. Mean and mean square are weighted, over the rays within one standard
/// deviation of the median (Shapira et al. 2008).
struct RayStatistics {
    float mean, median, mean_square;
};
/// Computes the statistics of the lengths that are not k_missed; nullopt if all are.
std::optional<RayStatistics> ray_statistics(std::span<const float> length, std::span<const float> weight);

/// Statistics per face and cone, faces x k_cones.
using ConeStatistics = std::vector<std::array<std::optional<RayStatistics>, k_cones>>;
/// Returns the 60 columns of a family of ray lengths: each statistic, clipped at its 95th percentile by area and
/// divided by it (so in [0, 1]), raw and as log(alpha x + 1) / log(alpha + 1) for alpha = 1, 2, 4, 8. A face without
/// rays gets the median of the others. Names: "FAMILY.mean@30", "FAMILY.mean@30/log2".
FeatureMatrix cone_features(const PreparedMesh& prepared, const std::string& family, const ConeStatistics& statistics);

}  // namespace exemplar
