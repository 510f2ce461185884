#include "host/hatching/features/direction_completion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "host/core/errors.h"
#include "host/core/parallel.h"

namespace exemplar {
namespace {

/// Orientations of circles around a point beside an image, without those in a square.
std::vector<DoubledAngle> circles(int width, int height, int hole) {
    std::vector<DoubledAngle> image;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const bool in_hole = std::abs(x - width / 2) < hole && std::abs(y - height / 2) < hole;
            const float angle = std::atan2(static_cast<float>(x + 40), static_cast<float>(y + 30));
            image.push_back(in_hole ? DoubledAngle{} : doubled_angle(angle));
        }
    return image;
}

TEST(CompleteDirections, GoesOverIntoWhatIsAround) {
    for (const auto& [width, height] : {std::pair{101, 77}, std::pair{64, 64}}) {
        const auto truth = circles(width, height, 0), given = circles(width, height, 20);
        auto image = given;
        complete_directions(width, height, image);
        for (std::size_t i = 0; i < image.size(); ++i) {
            if (given[i] != DoubledAngle{}) {
                ASSERT_EQ(image[i], given[i]);
                continue;
            }
            ASSERT_NEAR(std::hypot(image[i][0], image[i][1]), 1, 1e-5);
            // Orientations around the hole span 90 degrees.
            ASSERT_LT(std::sqrt(squared_distance(image[i], truth[i])), 2 * std::sin(0.35)) << i;
        }
    }
}

TEST(CompleteDirections, KeepsOneDirection) {
    const DoubledAngle direction = doubled_angle(2.5f);
    for (const auto& [width, height] : {std::pair{1, 1}, std::pair{1, 9}, std::pair{13, 1}, std::pair{30, 17}}) {
        std::vector<DoubledAngle> image(static_cast<std::size_t>(width * height));
        image.back() = direction;
        complete_directions(width, height, image);
        for (const DoubledAngle& value : image) ASSERT_NEAR(squared_distance(value, direction), 0, 1e-10);
    }
}

TEST(CompleteDirections, LeavesNothingAsItIs) {
    std::vector<DoubledAngle> image(35), none;
    complete_directions(7, 5, image);
    for (const DoubledAngle& value : image) EXPECT_EQ(value, DoubledAngle{});
    complete_directions(0, 0, none);
    EXPECT_THROW(complete_directions(7, 6, image), UsageError);
    EXPECT_THROW(complete_directions(-7, -5, image), UsageError);
}

TEST(CompleteDirections, IsTheSameOnAnyNumberOfThreads) {
    auto one = circles(301, 203, 70), three = one;
    {
        const ThreadLimit limit(1);
        complete_directions(301, 203, one);
    }
    const ThreadLimit limit(3);
    complete_directions(301, 203, three);
    EXPECT_EQ(one, three);
}

}  // namespace
}  // namespace exemplar
