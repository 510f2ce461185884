#include "host/shape/neighborhoods.h"

namespace exemplar {

std::size_t choose_max_neighborhood(const PreparedMesh& prepared, float radius) {
    constexpr std::size_t k_tried = 64, k_crowded = 1024;
    const std::size_t faces = prepared.face_count(), most = max_neighborhood(faces);
    if (most <= k_crowded) return most;
    GeodesicSearch search(prepared.graph);
    std::size_t sum = 0;
    for (std::size_t i = 0; i < k_tried; ++i)
        sum += search.within(static_cast<std::uint32_t>(i * faces / k_tried), radius, most).size();
    return sum / k_tried > faces / 8 ? k_crowded : most;
}

}  // namespace exemplar
