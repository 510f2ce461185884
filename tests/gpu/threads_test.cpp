#include "gpu/runtime/kernels/threads.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>

namespace exemplar {
namespace {

// Real devices differ in how many groups an axis holds, so folding is tested with small limits.
TEST(Threads, FoldedBoxesHoldAllGroupsWithinTheLimits) {
    constexpr std::array<std::uint32_t, 3> k_limit{7, 5, 3};
    for (std::uint64_t groups = 1; groups <= 7 * 5 * 3; ++groups) {
        const auto [x, y, z] = fold_groups(groups, k_limit);
        SCOPED_TRACE(groups);
        EXPECT_GE(x * y * z, groups);
        EXPECT_LT(x * y * z - groups, y * z);  // less than one more per row
        EXPECT_LE(x, 7u);
        EXPECT_LE(y, 5u);
        EXPECT_LE(z, 3u);
    }
    EXPECT_GT(fold_groups(7 * 5 * 3 + 1, k_limit)[2], 3u);
}

TEST(Threads, FewGroupsStayInOneRow) {
    constexpr std::array<std::uint32_t, 3> k_limit{65535, 65535, 65535};
    EXPECT_EQ(fold_groups(65535, k_limit), (std::array<std::uint64_t, 3>{65535, 1, 1}));
    EXPECT_EQ(fold_groups(65536, k_limit), (std::array<std::uint64_t, 3>{32768, 2, 1}));
    EXPECT_EQ(fold_groups((std::uint64_t{1} << 33) - 1, k_limit)[2], 3u);
}

}  // namespace
}  // namespace exemplar
