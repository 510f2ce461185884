#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "host/learn/boosting/lanes.h"
#include "host/learn/boosting/quantize.h"

namespace exemplar {

constexpr std::int32_t k_no_lane = -1;

/// A run of rows of the same class.
struct RowChunk {
    std::uint32_t begin, end;
    std::int32_t lane;  ///< lane of the rows' class, or k_no_lane
};

/// The training rows in the order in which boosting reads them: sorted by class, and shuffled within a class.
/// Neighbors on a surface share bins, and adding to the same bin again and again would stall the processor. Sorting
/// by class makes the sum over the rows with z = +1 a by-product: it is the chunk's own lane.
struct BoostingRows {
    LaneLayout layout;
    std::size_t count = 0;
    std::vector<std::uint8_t> bins;  ///< features x count, feature-major
    std::vector<RowChunk> chunks;    ///< cover all rows, in order
    AlignedFloats weights;           ///< panels x count x layout.width; padding lanes are zero

    const std::uint8_t* column(std::size_t feature) const { return bins.data() + feature * count; }
    float* panel(std::size_t index) { return weights.data() + index * count * layout.width; }
    const float* panel(std::size_t index) const { return weights.data() + index * count * layout.width; }
};

/// Collects `rows` of `features`. `lane`: the lane of the class of each entry of `rows`; `weight(entry, lane)`: its
/// weight. Chunks have at most `chunk_rows` rows.
template <typename Weight>
BoostingRows collect_rows(const QuantizedFeatures& features, std::span<const std::uint32_t> rows,
                          std::span<const std::int32_t> lane, std::size_t lanes, std::uint64_t seed,
                          std::size_t chunk_rows, Weight&& weight);

/// Returns the row order of collect_rows: indices into `lane`.
std::vector<std::uint32_t> class_order(std::span<const std::int32_t> lane, std::uint64_t seed);
/// Splits the sorted rows into chunks of one class.
std::vector<RowChunk> make_chunks(std::span<const std::int32_t> lane, std::span<const std::uint32_t> order,
                                  std::size_t chunk_rows);
/// Returns the bins of the chosen rows, features x order.size().
std::vector<std::uint8_t> gather_bins(const QuantizedFeatures& features, std::span<const std::uint32_t> rows,
                                      std::span<const std::uint32_t> order);

template <typename Weight>
BoostingRows collect_rows(const QuantizedFeatures& features, std::span<const std::uint32_t> rows,
                          std::span<const std::int32_t> lane, std::size_t lanes, std::uint64_t seed,
                          std::size_t chunk_rows, Weight&& weight) {
    const std::vector<std::uint32_t> order = class_order(lane, seed);
    BoostingRows out{
        LaneLayout(lanes), order.size(), gather_bins(features, rows, order), make_chunks(lane, order, chunk_rows), {}};
    const std::size_t width = out.layout.width;
    out.weights.resize(out.layout.panels * out.count * width, 0.0f);
    for (std::size_t i = 0; i < out.count; ++i) {
        for (std::size_t l = 0; l < lanes; ++l) out.panel(l / width)[i * width + l % width] = weight(order[i], l);
    }
    return out;
}

}  // namespace exemplar
