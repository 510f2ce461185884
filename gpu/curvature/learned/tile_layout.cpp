#include "gpu/curvature/learned/tile_layout.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <string>
#include <vector>

#include "gpu/runtime/vulkan/errors.h"
#include "host/core/errors.h"

namespace exemplar {
namespace {

using shared::k_principal_head;
using shared::k_tensor_head;
using shared::k_tile_quads;
using shared::uvec4;

constexpr std::size_t k_lanes = BasisTiles::k_lanes;
constexpr std::uint32_t k_group = 4;  // entries
static_assert(k_lanes == std::size_t{4} * k_tile_quads);
static_assert(k_max_attributes == 8, "the counts of a tile are one texel");

// The halves of a tile's lanes.
using Row = std::array<Half, k_lanes>;

[[noreturn]] void refuse_tiles(const std::string& what) {
    throw ModelError("a curvature model is damaged: " + what + "; train it again");
}

bool is_tensor(const BasisTiles& tiles) {
    return tiles.set == AttributeSet::tensor;
}

void check_tiles(const BasisTiles& tiles, std::size_t components, std::size_t segments) {
    const std::size_t count = tiles.tile_count(), attributes = attribute_count(tiles.set);
    const std::vector<std::uint32_t>& begin = tiles.entry_begin;
    if (tiles.vertex.size() != count * k_lanes || tiles.mean.size() != count * attributes * k_lanes ||
        tiles.neighbor.size() != (is_tensor(tiles) ? count * k_lanes : 0) ||
        tiles.reference.size() != (is_tensor(tiles) ? 0 : count * 3 * k_lanes) ||
        begin.size() != count * attributes + 1 || begin.back() != tiles.entry.size() ||
        tiles.basis.size() != tiles.entry.size() * k_lanes || tiles.scale.size() != attributes ||
        !std::is_sorted(begin.begin(), begin.end()))
        refuse_tiles(fmt::format("its parts are not those of {} tiles of {} attributes", count, attributes));
    const auto beyond = [](const auto& values, std::size_t most) {
        return std::any_of(values.begin(), values.end(), [&](std::size_t value) { return value >= most; });
    };
    if (beyond(tiles.vertex, tiles.vertex_count) || beyond(tiles.neighbor, tiles.vertex_count))
        refuse_tiles("a tile has a vertex that does not exist");
    if (std::ranges::any_of(tiles.entry, [&](auto entry) { return BasisTiles::component_of(entry) >= components; }))
        refuse_tiles("a tile has a component that does not exist");
    if (!is_tensor(tiles) && beyond(tiles.segment, segments))
        refuse_tiles("a tile is of a segment that does not exist");
}

Row row_at(const std::vector<Half>& halves, std::size_t index) {
    Row row;
    std::copy_n(halves.begin() + static_cast<std::ptrdiff_t>(index * k_lanes), k_lanes, row.begin());
    return row;
}

std::uint32_t packed(Half low, Half high) {
    return low.bits | static_cast<std::uint32_t>(high.bits) << 16;
}

std::uint32_t packed(const std::int8_t* four) {
    std::uint32_t word = 0;
    for (std::uint32_t i = 0; i < 4; ++i) word |= std::uint32_t{static_cast<std::uint8_t>(four[i])} << 8 * i;
    return word;
}

void append_pair(const Row& a, const Row& b, std::vector<uvec4>& texels) {
    for (std::size_t i = 0; i < k_lanes; i += 4)
        texels.push_back(
            {packed(a[i], a[i + 1]), packed(a[i + 2], a[i + 3]), packed(b[i], b[i + 1]), packed(b[i + 2], b[i + 3])});
}

// Appends the means of a tile and its reference normals, if there are any.
void append_constants(const BasisTiles& tiles, std::size_t tile, std::vector<uvec4>& texels) {
    const std::size_t attributes = attribute_count(tiles.set);
    std::vector<Row> rows;
    for (std::size_t a = 0; a < attributes; ++a) rows.push_back(row_at(tiles.mean, tile * attributes + a));
    for (std::size_t i = 0; !is_tensor(tiles) && i < 3; ++i) rows.push_back(row_at(tiles.reference, tile * 3 + i));
    if (rows.size() % 2 != 0) rows.emplace_back();
    for (std::size_t i = 0; i < rows.size(); i += 2) append_pair(rows[i], rows[i + 1], texels);
}

void append_indices(const std::vector<std::uint32_t>& indices, std::size_t tile, std::vector<uvec4>& texels) {
    const std::uint32_t* const of_tile = indices.data() + tile * k_lanes;
    for (std::size_t i = 0; i < k_lanes; i += 4)
        texels.push_back({of_tile[i], of_tile[i + 1], of_tile[i + 2], of_tile[i + 3]});
}

// The range of entries of an attribute of a tile.
struct Entries {
    std::uint32_t begin, end;
    std::uint32_t groups() const { return (end - begin + k_group - 1) / k_group; }
};

Entries entries_at(const BasisTiles& tiles, std::size_t tile, std::size_t attribute) {
    const std::size_t row = tile * attribute_count(tiles.set) + attribute;
    return {tiles.entry_begin[row], tiles.entry_begin[row + 1]};
}

void append_entries(const BasisTiles& tiles, Entries entries, TileLayout& layout) {
    for (std::uint32_t first = entries.begin; first < entries.end; first += k_group) {
        std::array<std::uint32_t, k_group> group;
        std::array<std::array<std::uint32_t, k_group>, k_tile_quads> words{};
        for (std::uint32_t i = 0; i < k_group; ++i) {
            const std::uint32_t e = first + i;
            // Padding is zero times a component the tile uses anyway, so that a non-finite one does not spread.
            group[i] = e < entries.end ? tiles.entry[e] : BasisTiles::component_of(tiles.entry[first]);
            for (std::size_t q = 0; e < entries.end && q < k_tile_quads; ++q)
                words[q][i] = packed(&tiles.basis[e * k_lanes + 4 * q]);
        }
        layout.groups.push_back({group[0], group[1], group[2], group[3]});
        for (const auto& w : words) layout.texels.push_back({w[0], w[1], w[2], w[3]});
    }
}

void append_tile(const BasisTiles& tiles, std::size_t tile, TileLayout& layout) {
    const std::size_t attributes = attribute_count(tiles.set);
    std::array<std::uint32_t, k_max_attributes> groups{};
    for (std::size_t a = 0; a < attributes; ++a) groups[a] = entries_at(tiles, tile, a).groups();
    const auto counts = [&](std::size_t a) { return groups[a] | groups[a + 1] << 16; };
    layout.texels.push_back({counts(0), counts(2), counts(4), counts(6)});
    append_indices(tiles.vertex, tile, layout.texels);
    if (is_tensor(tiles)) append_indices(tiles.neighbor, tile, layout.texels);
    append_constants(tiles, tile, layout.texels);
    for (std::size_t a = 0; a < attributes; ++a) append_entries(tiles, entries_at(tiles, tile, a), layout);
}

std::size_t groups_of(const BasisTiles& tiles, std::size_t tile) {
    std::size_t groups = 0;
    for (std::size_t a = 0; a < attribute_count(tiles.set); ++a) groups += entries_at(tiles, tile, a).groups();
    return groups;
}

std::size_t texels_of(const BasisTiles& tiles, std::size_t tile) {
    const std::size_t constants = attribute_count(tiles.set) + (is_tensor(tiles) ? 0 : 3);
    return (is_tensor(tiles) ? k_tensor_head : k_principal_head) +
           k_tile_quads * ((constants + 1) / 2 + groups_of(tiles, tile));
}

// Returns a step, near the golden ratio times `count` and coprime to it, whose multiples modulo `count` visit
// everything and are evenly spread in any stretch.
std::size_t spreading_step(std::size_t count) {
    auto step = static_cast<std::size_t>(0.618 * static_cast<double>(count));
    while (std::gcd(step, count) != 1) ++step;
    return step;
}

// Orders tiles by work. Invocations of a subgroup wait for the one with the most groups, so runs of k_run tiles have
// similar numbers of groups. Runs with few and many groups are interleaved, so that cores with equal shares of the
// tiles have about equal work. Windows limit the reordering, so that neighbors on the surface stay close in time.
std::vector<std::uint32_t> order_by_work(const BasisTiles& tiles) {
    constexpr std::size_t k_run = 8, k_window = 512;
    std::vector<std::size_t> groups;
    for (std::size_t t = 0; t < tiles.tile_count(); ++t) groups.push_back(groups_of(tiles, t));
    std::vector<std::uint32_t> order;
    for (std::size_t first = 0; first < groups.size(); first += k_window) {
        std::vector<std::uint32_t> sorted(std::min(k_window, groups.size() - first));
        std::iota(sorted.begin(), sorted.end(), static_cast<std::uint32_t>(first));
        std::ranges::stable_sort(sorted, {}, [&](std::uint32_t t) { return groups[t]; });
        const std::size_t runs = sorted.size() / k_run, step = spreading_step(runs);
        for (std::size_t i = 0; i < runs * k_run; ++i)
            order.push_back(sorted[i / k_run * step % runs * k_run + i % k_run]);
        order.insert(order.end(), sorted.begin() + static_cast<std::ptrdiff_t>(runs * k_run), sorted.end());
    }
    return order;
}

void pad(std::size_t alignment, TileLayout& layout) {
    while (layout.texels.size() * sizeof(uvec4) % alignment != 0) layout.texels.push_back({});
    while (layout.groups.size() * sizeof(uvec4) % alignment != 0) layout.groups.push_back({});
}

}  // namespace

TileLayout lay_out_tiles(const BasisTiles& tiles, std::size_t components, std::size_t segments,
                         std::size_t max_texels_per_range, std::size_t alignment) {
    check_tiles(tiles, components, segments);
    TileLayout layout;
    for (const std::uint32_t t : order_by_work(tiles)) {
        const std::size_t texels = texels_of(tiles, t);
        if (texels > max_texels_per_range)
            throw DeviceLimitError(fmt::format("16 vertices of a curvature model need {} texels, over the device's "
                                               "limit of {}; train it with fewer components",
                                               texels, max_texels_per_range),
                                   texels, max_texels_per_range);
        if (layout.ranges.empty() || layout.ranges.back().texels + texels > max_texels_per_range) {
            pad(alignment, layout);
            layout.ranges.push_back(
                {static_cast<std::uint32_t>(layout.table.size()), 0, layout.texels.size(), 0, layout.groups.size(), 0});
        }
        layout.table.push_back({.first_texel = static_cast<std::uint32_t>(layout.texels.size()),
                                .first_group = static_cast<std::uint32_t>(layout.groups.size()),
                                .segment = tiles.segment[t],
                                .unused = 0});
        append_tile(tiles, t, layout);
        TileLayout::Range& range = layout.ranges.back();
        ++range.tiles;
        range.texels = layout.texels.size() - range.first_texel;
        range.groups = layout.groups.size() - range.first_group;
    }
    return layout;
}

}  // namespace exemplar
