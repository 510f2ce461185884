#include "host/labeling/features/edge_context.h"

#include <array>

#include "host/core/parallel.h"

namespace exemplar {

void accumulate_edge_context(const MeshFeatures& features, std::span<const float> boundary_probability,
                             std::span<float> out) {
    constexpr std::size_t k_bins = EdgeNeighborhood::k_bins;
    const EdgeNeighborhood& near = features.edge_context;
    const std::size_t edges = features.edges.size();
    const auto sum_edge = [&](std::size_t e) {
        std::array<float, k_bins> sum{};
        float length = 0;
        for (std::uint32_t i = near.begin[e]; i < near.begin[e + 1]; ++i) {
            const float weight = features.edge_length[near.edge[i]];
            sum[near.bin[i]] += weight * boundary_probability[near.edge[i]];
            length += weight;
        }
        for (std::size_t b = 0; b < k_bins; ++b) out[b * edges + e] = length > 0 ? sum[b] / length : 0;
    };
    parallel_for(edges, sum_edge, 256);
}

}  // namespace exemplar
