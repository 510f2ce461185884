#include "host/learn/boosting/boosting_rows.h"

#include <algorithm>
#include <numeric>

#include "host/core/parallel.h"
#include "host/core/random.h"

namespace exemplar {

std::vector<std::uint32_t> class_order(std::span<const std::int32_t> lane, std::uint64_t seed) {
    std::vector<std::uint32_t> order(lane.size());
    std::iota(order.begin(), order.end(), 0u);
    Random(seed).shuffle(order);
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return lane[a] < lane[b]; });
    return order;
}

std::vector<RowChunk> make_chunks(std::span<const std::int32_t> lane, std::span<const std::uint32_t> order,
                                  std::size_t chunk_rows) {
    std::vector<RowChunk> chunks;
    for (std::size_t i = 0; i < order.size(); ++i) {
        const std::int32_t own = lane[order[i]];
        if (chunks.empty() || chunks.back().lane != own || chunks.back().end - chunks.back().begin == chunk_rows) {
            chunks.push_back({static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(i), own});
        }
        ++chunks.back().end;
    }
    return chunks;
}

std::vector<std::uint8_t> gather_bins(const QuantizedFeatures& features, std::span<const std::uint32_t> rows,
                                      std::span<const std::uint32_t> order) {
    std::vector<std::uint8_t> bins(features.cols() * order.size());
    parallel_for(features.cols(), [&](std::size_t feature) {
        const std::span<const std::uint8_t> column = features.column(feature);
        std::uint8_t* out = bins.data() + feature * order.size();
        for (std::size_t i = 0; i < order.size(); ++i) out[i] = column[rows[order[i]]];
    });
    return bins;
}

}  // namespace exemplar
