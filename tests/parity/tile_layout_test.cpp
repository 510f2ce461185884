#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <utility>

#include "gpu/curvature/tile_layout.h"
#include "gpu/runtime/errors.h"
#include "host/core/errors.h"
#include "tests/parity/random_model.h"

namespace exemplar {
namespace {

using testing::RandomModel;

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
                EXPECT_EQ(range.first_pair * sizeof(std::uint32_t) % alignment, 0u);
                EXPECT_LE(range.texels, most);
                EXPECT_EQ(layout.table[next].first_texel, range.first_texel);
                EXPECT_EQ(layout.table[next].first_pair, range.first_pair);
                next += range.tiles;
            }
            EXPECT_EQ(next, tiles.tile_count());
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
