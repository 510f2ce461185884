#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>
#include <set>
#include <string>
#include <utility>

#include "gpu/curvature/learned/tile_layout.h"
#include "gpu/runtime/vulkan/errors.h"
#include "host/core/errors.h"
#include "tests/parity/random_model.h"

namespace exemplar {
namespace {

using test_support::RandomModel;

// Each tile lies whole in one range.
TEST(TileLayout, IsCutToTheLimit) {
    RandomModel random({.vertices = 500}, 5);
    const BasisTiles& tiles = random.model.tiles;
    const std::size_t components = random.model.regression.components.size();
    for (const std::size_t most : {std::size_t{700}, std::size_t{3000}, std::size_t{1} << 20})
        for (const std::size_t alignment : {1u, 16u, 256u}) {
            const TileLayout layout = lay_out_tiles(tiles, components, 3, most, alignment);
            std::uint32_t next = 0;
            for (const TileLayout::Range& range : layout.ranges) {
                EXPECT_EQ(range.first_tile, next);
                EXPECT_EQ(range.first_texel * sizeof(shared::uvec4) % alignment, 0u);
                EXPECT_EQ(range.first_group * sizeof(shared::uvec4) % alignment, 0u);
                EXPECT_LE(range.texels, most);
                EXPECT_EQ(layout.table[next].first_texel, range.first_texel);
                EXPECT_EQ(layout.table[next].first_group, range.first_group);
                next += range.tiles;
            }
            EXPECT_EQ(next, tiles.tile_count());
        }
}

// Tile t has t / 4 groups of each attribute.
BasisTiles growing_tiles(std::uint32_t count) {
    BasisTiles tiles;
    tiles.vertex_count = count * BasisTiles::k_lanes;
    tiles.vertex.resize(tiles.vertex_count);
    std::iota(tiles.vertex.begin(), tiles.vertex.end(), 0u);
    tiles.neighbor = tiles.vertex;
    tiles.segment.resize(count);
    tiles.scale.resize(7);
    tiles.mean.resize(7 * tiles.vertex_count);
    tiles.entry_begin = {0};
    for (std::uint32_t t = 0; t < count; ++t)
        tiles.entry_begin.insert(tiles.entry_begin.end(), 7, tiles.entry_begin.back() + t / 4 * 4);
    tiles.entry.resize(tiles.entry_begin.back());
    tiles.basis.resize(tiles.entry.size() * BasisTiles::k_lanes);
    return tiles;
}

TEST(TileLayout, HasEveryTileOnce) {
    for (const std::uint32_t count : {1u, 7u, 8u, 9u, 130u, 517u}) {
        const TileLayout layout = lay_out_tiles(growing_tiles(count), 1, 0, 1 << 20, 16);
        ASSERT_EQ(layout.table.size(), count);
        std::set<std::uint32_t> vertices;
        for (const shared::CurvatureTile& tile : layout.table)
            for (std::size_t quad = 0; quad < shared::k_tile_quads; ++quad) {
                const shared::uvec4& four = layout.texels[tile.first_texel + 1 + quad];
                vertices.insert({four.x, four.y, four.z, four.w});
            }
        EXPECT_EQ(vertices.size(), count * BasisTiles::k_lanes);
    }
}

TEST(TileLayout, GivesEqualSharesOfTilesAboutEqualWork) {
    constexpr std::uint32_t k_count = 512;
    const TileLayout layout = lay_out_tiles(growing_tiles(k_count), 1, 0, 1 << 24, 16);
    const auto first_group = [&](std::size_t tile) {
        return tile < k_count ? layout.table[tile].first_group : static_cast<std::uint32_t>(layout.groups.size());
    };
    const double all = first_group(k_count);
    for (const std::size_t shares : {2u, 4u})
        for (std::size_t i = 0; i < shares; ++i) {
            const double share = first_group((i + 1) * k_count / shares) - first_group(i * k_count / shares);
            EXPECT_NEAR(share * static_cast<double>(shares) / all, 1, 0.15) << i << " of " << shares;
        }
    // And those that run in step have alike.
    for (std::size_t run = 0; run < k_count; run += 8) {
        const double first = first_group(run + 1) - first_group(run),
                     last = first_group(run + 8) - first_group(run + 7);
        EXPECT_LE(last - first, 2 * 7);
    }
}

TEST(TileLayout, RefusesATileOverTheLimit) {
    RandomModel random({}, 5);
    try {
        lay_out_tiles(random.model.tiles, random.model.regression.components.size(), 3, 26, 16);
        FAIL();
    } catch (const DeviceLimitError& error) {
        EXPECT_EQ(error.limit, 26u);
        EXPECT_GT(error.requested, 26u);
        EXPECT_THAT(error.what(), ::testing::HasSubstr(std::to_string(error.requested)));
    }
}

TEST(TileLayout, RefusesTilesThatReferToNothing) {
    RandomModel random({}, 5);
    const BasisTiles& good = random.model.tiles;
    const std::size_t components = random.model.regression.components.size();
    EXPECT_NO_THROW(lay_out_tiles(good, components, 3, 10000, 16));
    EXPECT_THROW(lay_out_tiles(good, components - 1, 3, 10000, 16), ModelError);
    EXPECT_NO_THROW(lay_out_tiles(good, components, 0, 10000, 16));
    const BasisTiles principal = RandomModel({.set = AttributeSet::principal}, 5).model.tiles;
    EXPECT_NO_THROW(lay_out_tiles(principal, 1000, 3, 10000, 16));
    EXPECT_THROW(lay_out_tiles(principal, 1000, 2, 10000, 16), ModelError);
    BasisTiles bad = good;
    bad.neighbor[17] = 200;
    EXPECT_THROW(lay_out_tiles(bad, components, 3, 10000, 16), ModelError);
    bad = good;
    bad.neighbor.pop_back();
    EXPECT_THROW(lay_out_tiles(bad, components, 3, 10000, 16), ModelError);
    bad = principal;
    bad.reference.pop_back();
    EXPECT_THROW(lay_out_tiles(bad, 1000, 3, 10000, 16), ModelError);
    bad = good;
    bad.vertex[17] = 200;
    EXPECT_THROW(lay_out_tiles(bad, components, 3, 10000, 16), ModelError);
    bad = good;
    bad.mean.pop_back();
    EXPECT_THROW(lay_out_tiles(bad, components, 3, 10000, 16), ModelError);
    bad = good;
    std::swap(bad.entry_begin[4], bad.entry_begin[30]);
    EXPECT_THROW(lay_out_tiles(bad, components, 3, 10000, 16), ModelError);
}

}  // namespace
}  // namespace exemplar
