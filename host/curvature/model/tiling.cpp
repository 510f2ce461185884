#include "host/curvature/model/tiling.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "host/core/errors.h"

namespace exemplar {

namespace {

constexpr std::size_t k_tile_lanes = BasisTiles::k_lanes;

/// Spreads the lower ten bits of `value` to every third bit.
std::uint32_t spread_bits(std::uint32_t value) {
    value = (value | value << 16) & 0x030000FF;
    value = (value | value << 8) & 0x0300F00F;
    value = (value | value << 4) & 0x030C30C3;
    return (value | value << 2) & 0x09249249;
}

/// Orders the vertices by segment and curve, and pads each segment to whole tiles with its last vertex.
void lay_out_vertices(const AttributeFrames& frames, std::span<const Vec3> rest, BasisTiles& tiles) {
    const std::vector<std::uint32_t> place = curve_places(rest);
    std::vector<std::uint32_t> order(frames.vertex_count());
    std::iota(order.begin(), order.end(), 0u);
    const auto segment_of = [&](std::uint32_t v) { return frames.segment.empty() ? 0 : frames.segment[v]; };
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return segment_of(a) != segment_of(b) ? segment_of(a) < segment_of(b) : place[a] < place[b];
    });
    for (std::size_t i = 0; i < order.size(); ++i) {
        const std::uint32_t segment = segment_of(order[i]);
        if (tiles.vertex.size() % k_tile_lanes == 0) tiles.segment.push_back(segment);
        tiles.vertex.push_back(order[i]);
        const bool ends = i + 1 == order.size() || segment_of(order[i + 1]) != segment;
        while (ends && tiles.vertex.size() % k_tile_lanes != 0) tiles.vertex.push_back(order[i]);
    }
}

/// The part of a component's basis that lies in one tile.
struct TileEntry {
    std::uint32_t tile;
    std::uint16_t component;
    float variance;  ///< summed over the lanes
    std::array<float, k_tile_lanes> basis;
};

/// Returns all nonzero entries of an attribute, sorted by tile.
std::vector<TileEntry> entries_of(const BasisTiles& tiles, std::size_t attribute, const std::vector<VertexBasis>& bases,
                                  const Eigen::MatrixXf& scales) {
    std::vector<TileEntry> entries;
    const auto scale_of = [&](std::uint32_t v) {
        return scales.size() ? scales(static_cast<Eigen::Index>(attribute), v) : 1.0f;
    };
    std::vector<Eigen::Index> row_of_vertex(tiles.vertex_count, -1);
    for (const VertexBasis& basis : bases) {
        if (basis.attribute != attribute || basis.basis.cols() == 0) continue;
        for (std::size_t i = 0; i < basis.vertices.size(); ++i)
            row_of_vertex[basis.vertices[i]] = static_cast<Eigen::Index>(i);
        for (std::uint32_t t = 0; t < tiles.tile_count(); ++t)
            for (Eigen::Index c = 0; c < basis.basis.cols(); ++c) {
                TileEntry entry{
                    t, static_cast<std::uint16_t>(basis.first_component + static_cast<std::uint32_t>(c)), 0, {}};
                for (std::size_t lane = 0; lane < k_tile_lanes; ++lane) {
                    const Eigen::Index row = row_of_vertex[tiles.vertex[t * k_tile_lanes + lane]];
                    entry.basis[lane] = row < 0 ? 0.0f : basis.basis(row, c);
                    const float scaled = entry.basis[lane] / scale_of(tiles.vertex[t * k_tile_lanes + lane]);
                    entry.variance += scaled * scaled;
                }
                if (entry.variance > 0) entries.push_back(entry);
            }
        for (const std::uint32_t v : basis.vertices) row_of_vertex[v] = -1;
    }
    std::stable_sort(entries.begin(), entries.end(),
                     [](const TileEntry& a, const TileEntry& b) { return a.tile < b.tile; });
    return entries;
}

void drop_weakest(std::vector<TileEntry>& entries, double share) {
    double total = 0;
    for (const TileEntry& entry : entries) total += entry.variance;
    std::vector<float> variances;
    variances.reserve(entries.size());
    for (const TileEntry& entry : entries) variances.push_back(entry.variance);
    std::sort(variances.begin(), variances.end());
    double dropped = 0;
    float least = 0;
    for (const float variance : variances) {
        least = variance;
        if (dropped + variance > share * total) break;
        dropped += variance;
    }
    entries.erase(
        std::remove_if(entries.begin(), entries.end(), [&](const TileEntry& entry) { return entry.variance < least; }),
        entries.end());
}

/// Returns the factor of half-precision means for which the largest one is stored as 1024, so that small ones keep
/// their precision.
float half_scale(const Eigen::Ref<const Eigen::RowVectorXf>& mean) {
    const float largest = mean.size() ? mean.cwiseAbs().maxCoeff() : 0.0f;
    return largest > 0 ? largest / 1024.0f : 1.0f;
}

void append_entry(const TileEntry& entry, BasisTiles& tiles) {
    constexpr float k_steps = 127;
    float largest = 0;
    for (const float value : entry.basis) largest = std::max(largest, std::abs(value));
    tiles.entry.push_back(BasisTiles::make_entry(entry.component, largest / k_steps));
    const float step = BasisTiles::step_of(tiles.entry.back());
    for (const float value : entry.basis) tiles.basis.push_back(static_cast<std::int8_t>(std::lround(value / step)));
}

}  // namespace

std::vector<std::uint32_t> curve_places(std::span<const Vec3> points) {
    Vec3 low = Vec3::Constant(std::numeric_limits<float>::max()), high = -low;
    for (const Vec3& p : points) {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
    }
    const float cell = std::max((high - low).maxCoeff(), std::numeric_limits<float>::min()) / 1023.0f;
    std::vector<std::uint32_t> places;
    places.reserve(points.size());
    for (const Vec3& p : points) {
        const Vec3 at = (p - low) / cell;
        places.push_back(spread_bits(static_cast<std::uint32_t>(at.x())) |
                         spread_bits(static_cast<std::uint32_t>(at.y())) << 1 |
                         spread_bits(static_cast<std::uint32_t>(at.z())) << 2);
    }
    return places;
}

BasisTiles make_tiles(const AttributeFrames& frames, std::span<const Vec3> rest,
                      const Eigen::Ref<const Eigen::MatrixXf>& means, const std::vector<VertexBasis>& bases,
                      const TilingOptions& options) {
    for (const VertexBasis& basis : bases)
        if (basis.first_component + static_cast<std::size_t>(basis.basis.cols()) > k_max_components)
            throw UsageError(
                fmt::format("a model can have {} components at most; keep less of the variance", k_max_components));
    BasisTiles tiles;
    tiles.set = frames.set;
    tiles.vertex_count = frames.vertex_count();
    lay_out_vertices(frames, rest, tiles);

    const std::size_t count = attribute_count(frames.set);
    std::vector<std::vector<TileEntry>> entries(count);
    for (std::size_t a = 0; a < count; ++a) {
        entries[a] = entries_of(tiles, a, bases, options.scales);
        drop_weakest(entries[a], options.dropped_variance);
        tiles.scale.push_back(half_scale(means.row(static_cast<Eigen::Index>(a))));
    }
    std::vector<std::size_t> next(count, 0);
    tiles.entry_begin.push_back(0);
    for (std::uint32_t t = 0; t < tiles.tile_count(); ++t)
        for (std::size_t a = 0; a < count; ++a) {
            for (; next[a] < entries[a].size() && entries[a][next[a]].tile == t; ++next[a])
                append_entry(entries[a][next[a]], tiles);
            tiles.entry_begin.push_back(static_cast<std::uint32_t>(tiles.entry.size()));
            for (std::size_t lane = 0; lane < k_tile_lanes; ++lane)
                tiles.mean.push_back(to_half(
                    means(static_cast<Eigen::Index>(a), tiles.vertex[t * k_tile_lanes + lane]) / tiles.scale[a]));
        }
    if (frames.set == AttributeSet::tensor)
        for (const std::uint32_t v : tiles.vertex) tiles.neighbor.push_back(frames.neighbor[v]);
    for (std::uint32_t t = 0; frames.set == AttributeSet::principal && t < tiles.tile_count(); ++t)
        for (Eigen::Index i = 0; i < 3; ++i)
            for (std::size_t lane = 0; lane < k_tile_lanes; ++lane)
                tiles.reference.push_back(to_half(frames.reference_normal[tiles.vertex[t * k_tile_lanes + lane]][i]));
    return tiles;
}

}  // namespace exemplar
