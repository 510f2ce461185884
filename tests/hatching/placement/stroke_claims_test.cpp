#include "host/hatching/placement/stroke_claims.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "host/hatching/placement/placement_grid.h"
#include "tests/support/hatching_scenes.h"

namespace exemplar {
namespace {

using namespace test_support;

/// Claims are counted down round by round, and begin anew when there are none left.
TEST(StrokeClaims, GoToTheLeastOfTheirRoundHoweverManyThereWere) {
    const HatchingFields fields = even_fields(30, 30, 0);
    const PlacementGrid grid = make_placement_grid(fields, {}, {});
    StrokeClaims claims(grid);
    const auto way = [](int y) {
        std::vector<FinePoint> points;
        for (int x = 5; x < 25; ++x) points.push_back({x * k_pixel, y * k_pixel});
        return points;
    };
    for (int round = 0; round < 9000; ++round) {
        claims.begin_round();
        const std::uint32_t full = claims.claim_of(7, 0), shorter = claims.claim_of(3, 1),
                            beside = claims.claim_of(4, 3);
        ASSERT_LT(full, shorter);
        claims.claim(0, way(10), shorter);
        claims.claim(0, way(14), full);
        claims.claim(0, way(20), beside);
        claims.claim(1, way(14), shorter);
        ASSERT_TRUE(claims.wins(0, way(14), full));
        ASSERT_FALSE(claims.wins(0, way(10), shorter));
        ASSERT_TRUE(claims.wins(0, way(20), beside));
        ASSERT_TRUE(claims.wins(1, way(14), shorter));
    }
}

TEST(StrokeClaims, AreAllDifferent) {
    const PlacementGrid grid = make_placement_grid(even_fields(3, 3, 0), {}, {});
    StrokeClaims claims(grid);
    claims.begin_round();
    std::vector<std::uint32_t> all;
    for (std::uint32_t place = 0; place < 1U << 18; ++place) all.push_back(claims.claim_of(place, place % 4));
    std::ranges::sort(all);
    EXPECT_EQ(std::ranges::adjacent_find(all), all.end());
}

}  // namespace
}  // namespace exemplar
