#include "host/hatching/fields/occlusion_barriers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "host/core/errors.h"

namespace exemplar {
namespace {

constexpr float k_nothing = std::numeric_limits<float>::infinity();

std::vector<float> depths(int width, int height, const std::function<float(float, float)>& depth) {
    std::vector<float> result;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) result.push_back(depth(static_cast<float>(x), static_cast<float>(y)));
    return result;
}

std::size_t barriers_of(const std::vector<std::uint8_t>& barriers) {
    return static_cast<std::size_t>(std::ranges::count_if(barriers, [](std::uint8_t bits) { return bits != 0; }));
}

TEST(OcclusionBarriers, PlanesHaveNoneHoweverSteep) {
    for (const float slope : {0.0f, 0.1f, 3.0f, 100.0f}) {
        const auto depth = depths(31, 17, [&](float x, float y) { return 5 + slope * x - 0.5f * slope * y; });
        EXPECT_EQ(barriers_of(occlusion_barriers(depth, 31, 17)), 0u) << slope;
    }
}

TEST(OcclusionBarriers, CreasesHaveNone) {
    const auto depth = depths(41, 9, [](float x, float) { return 4 + 2 * std::abs(x - 20.3f); });
    EXPECT_EQ(barriers_of(occlusion_barriers(depth, 41, 9)), 0u);
}

TEST(OcclusionBarriers, AStepHasOneAlongIt) {
    const auto depth = depths(20, 10, [](float x, float y) { return (x < 8 ? 3.0f : 4.0f) + 0.02f * y; });
    const auto barriers = occlusion_barriers(depth, 20, 10);
    for (std::size_t i = 0; i < barriers.size(); ++i) EXPECT_EQ(barriers[i], i % 20 == 7 ? k_barrier_right : 0) << i;
}

TEST(OcclusionBarriers, SomethingEndsAtNothing) {
    const auto depth = depths(9, 9, [](float x, float y) { return x == 4 && y == 4 ? 2.0f : k_nothing; });
    const auto barriers = occlusion_barriers(depth, 9, 9);
    EXPECT_EQ(barriers[4 * 9 + 4], k_barrier_right | k_barrier_below);
    EXPECT_EQ(barriers[4 * 9 + 3], k_barrier_right);
    EXPECT_EQ(barriers[3 * 9 + 4], k_barrier_below);
    EXPECT_EQ(barriers_of(barriers), 3u);
}

/// A ball before a wall: the barrier is a closed line around the ball and nowhere else.
TEST(OcclusionBarriers, ABallIsDividedFromTheWallBehindIt) {
    constexpr int k_barrier_image = 101;
    constexpr float k_radius = 40;
    const auto is_ball = [](float x, float y) { return std::hypot(x - 50, y - 50) < k_radius; };
    const auto depth = depths(k_barrier_image, k_barrier_image, [&](float x, float y) {
        return is_ball(x, y) ? 100 - std::sqrt(k_radius * k_radius - (x - 50) * (x - 50) - (y - 50) * (y - 50))
                             : 130 + 0.1f * x;
    });
    const auto barriers = occlusion_barriers(depth, k_barrier_image, k_barrier_image);
    for (int y = 0; y + 1 < k_barrier_image; ++y)
        for (int x = 0; x + 1 < k_barrier_image; ++x) {
            const auto fx = static_cast<float>(x), fy = static_cast<float>(y);
            const std::uint8_t bits =
                barriers[static_cast<std::size_t>(y) * k_barrier_image + static_cast<std::size_t>(x)];
            EXPECT_EQ((bits & k_barrier_right) != 0, is_ball(fx, fy) != is_ball(fx + 1, fy)) << x << " " << y;
            EXPECT_EQ((bits & k_barrier_below) != 0, is_ball(fx, fy) != is_ball(fx, fy + 1)) << x << " " << y;
        }
}

TEST(OcclusionBarriers, DoNotDependOnTheUnitOfDepth) {
    const auto shape = [](float x, float y) { return x < 12 ? std::sin(0.3f * x) + y : 9 + 0.2f * x * x; };
    const auto small = depths(30, 20, shape),
               large = depths(30, 20, [&](float x, float y) { return 1024 * shape(x, y); });
    EXPECT_EQ(occlusion_barriers(small, 30, 20), occlusion_barriers(large, 30, 20));
    EXPECT_GT(barriers_of(occlusion_barriers(small, 30, 20)), 0u);
}

TEST(OcclusionBarriers, TakesEmptyPicturesAndNoWrongSizes) {
    EXPECT_TRUE(occlusion_barriers({}, 0, 7).empty());
    EXPECT_EQ(occlusion_barriers(std::vector<float>{k_nothing}, 1, 1), std::vector<std::uint8_t>{0});
    EXPECT_THROW(occlusion_barriers(std::vector<float>(6), 2, 2), UsageError);
    EXPECT_THROW(occlusion_barriers({}, -1, 0), UsageError);
}

}  // namespace
}  // namespace exemplar
