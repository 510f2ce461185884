#include "host/core/parallel.h"
#include "host/shape/shape_families.h"

namespace exemplar {

/// A cone without valid rays takes the values of the next wider cone that has one; cone_features handles faces
/// without any ray.
FeatureMatrix diameter_features(const PreparedMesh& prepared, const InwardRays& rays) {
    const InwardRayPattern& pattern = inward_ray_pattern();
    ConeStatistics statistics(prepared.face_count());
    const auto measure = [&](std::size_t f) {
        const std::span<const float> length = rays.of_face(f), weight = pattern.weight;
        for (std::size_t cone = k_cones; cone-- > 0;) {
            const std::size_t count = pattern.cone_end[cone];
            statistics[f][cone] = ray_statistics(length.first(count), weight.first(count));
            if (!statistics[f][cone] && cone + 1 < k_cones) statistics[f][cone] = statistics[f][cone + 1];
        }
    };
    parallel_for(prepared.face_count(), measure, 256);
    return cone_features(prepared, "diameter", statistics);
}

}  // namespace exemplar
