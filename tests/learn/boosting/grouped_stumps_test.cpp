#include "host/learn/boosting/grouped_stumps.h"

#include <gtest/gtest.h>

#include <tuple>

namespace exemplar {
namespace {

bool equal(const Stump& a, const Stump& b) {
    const auto parts = [](const Stump& s) { return std::tuple(s.feature, s.threshold, s.above, s.below, s.classes); };
    return parts(a) == parts(b);
}

TEST(GroupedStumps, AreByClassesAndThoseThatAskTheSameAreOne) {
    const BoostedStumps classifier{3,
                                   {{4, 0.5F, 1, -1, 6},
                                    {2, 0.5F, 2, -2, 5},
                                    {4, 0.5F, 4, -8, 6},
                                    {4, 0.25F, 16, -16, 6},
                                    {4, 0.5F, 32, -32, 5},
                                    {3, 0.5F, 64, -64, 6}},
                                   std::vector<float>(18)};
    const GroupedStumps grouped(classifier);
    ASSERT_EQ(grouped.groups.size(), 2U);
    ASSERT_EQ(grouped.stumps.size(), 5U);
    EXPECT_EQ(grouped.groups[0].classes, 5U);
    EXPECT_EQ(grouped.groups[0].first, 0U);
    EXPECT_EQ(grouped.groups[0].end, 2U);
    EXPECT_TRUE(equal(grouped.stumps[0], {2, 0.5F, 2, -2, 5}));
    EXPECT_TRUE(equal(grouped.stumps[1], {4, 0.5F, 32, -32, 5}));
    EXPECT_EQ(grouped.groups[1].classes, 6U);
    EXPECT_EQ(grouped.groups[1].first, 2U);
    EXPECT_EQ(grouped.groups[1].end, 5U);
    EXPECT_TRUE(equal(grouped.stumps[2], {3, 0.5F, 64, -64, 6}));
    EXPECT_TRUE(equal(grouped.stumps[3], {4, 0.25F, 16, -16, 6}));
    EXPECT_TRUE(equal(grouped.stumps[4], {4, 0.5F, 5, -9, 6}));
}

TEST(GroupedStumps, OfNoStumps) {
    const GroupedStumps grouped({3, {}, {}});
    EXPECT_TRUE(grouped.groups.empty());
    EXPECT_TRUE(grouped.stumps.empty());
}

}  // namespace
}  // namespace exemplar
