#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "host/core/random.h"
#include "host/hatching/tracing/drawing_filters.h"
#include "host/hatching/tracing/region_outline.h"
#include "host/hatching/tracing/thinning.h"
#include "tests/hatching/measurement/test_drawings.h"

namespace exemplar {
namespace {

PixelMask random_blobs(int width, int height, std::uint64_t seed) {
    Random random(seed);
    PixelMask mask(width, height, 1);
    for (int blob = 0; blob < 14; ++blob) {
        const auto cx = static_cast<float>(random.uniform(0, width)),
                   cy = static_cast<float>(random.uniform(0, height));
        const auto r = static_cast<float>(random.uniform(1, 9));
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x)
                if (std::hypot(static_cast<float>(x) - cx, static_cast<float>(y) - cy) < r) mask.pixel(x, y)[0] = 1;
    }
    return mask;
}

/// How many pieces connected by eight neighbors a mask has, and how many holes connected by four.
std::array<int, 2> pieces_and_holes(const PixelMask& mask) {
    PixelMask framed(mask.width + 2, mask.height + 2, 1);
    for (int y = 0; y < mask.height; ++y)
        for (int x = 0; x < mask.width; ++x) framed.pixel(x + 1, y + 1)[0] = mask.pixel(x, y)[0];
    std::array<int, 2> count{0, -1};  // the outside is no hole
    PixelMask seen(framed.width, framed.height, 1);
    for (int y = 0; y < framed.height; ++y)
        for (int x = 0; x < framed.width; ++x) {
            if (seen.pixel(x, y)[0]) continue;
            const bool set = framed.pixel(x, y)[0];
            ++count[set ? 0 : 1];
            std::vector<Pixel> stack{{x, y}};
            seen.pixel(x, y)[0] = 1;
            while (!stack.empty()) {
                const Pixel at = stack.back();
                stack.pop_back();
                for (std::size_t k = 0; k < 8; k += set ? 1 : 2) {
                    const int px = at[0] + k_neighbor_offsets[k][0], py = at[1] + k_neighbor_offsets[k][1];
                    if (px < 0 || py < 0 || px >= framed.width || py >= framed.height || seen.pixel(px, py)[0] ||
                        (framed.pixel(px, py)[0] != 0) != set)
                        continue;
                    seen.pixel(px, py)[0] = 1;
                    stack.push_back({px, py});
                }
            }
        }
    return count;
}

TEST(Thinning, KeepsPiecesAndHolesAndLeavesThinLines) {
    for (const std::uint64_t seed : {1u, 2u, 3u, 4u, 5u}) {
        const PixelMask mask = random_blobs(71, 53, seed), thin = thinned(mask);
        EXPECT_EQ(pieces_and_holes(thin), pieces_and_holes(mask)) << seed;
        for (int y = 0; y + 1 < mask.height; ++y)
            for (int x = 0; x + 1 < mask.width; ++x) {
                EXPECT_LE(thin.pixel(x, y)[0], mask.pixel(x, y)[0]);
                EXPECT_LE(thin.pixel(x, y)[0] + thin.pixel(x + 1, y)[0] + thin.pixel(x, y + 1)[0] +
                              thin.pixel(x + 1, y + 1)[0],
                          3);
            }
    }
}

TEST(Thinning, FindsTheMiddleOfABar) {
    PixelMask bar(60, 21, 1);
    for (int y = 6; y < 13; ++y)
        for (int x = 5; x < 55; ++x) bar.pixel(x, y)[0] = 1;
    const PixelMask thin = thinned(bar);
    for (int x = 12; x < 48; ++x)
        for (int y = 0; y < 21; ++y) EXPECT_EQ(thin.pixel(x, y)[0], y == 9) << x << ", " << y;
}

TEST(NearestSites, AreThoseOfASearchThroughAll) {
    for (const auto& [width, height] : {std::pair{1, 1}, std::pair{1, 17}, std::pair{23, 1}, std::pair{31, 26}}) {
        Random random(static_cast<std::uint64_t>(width));
        for (const double density : {0.0, 0.02, 0.2, 1.0}) {
            std::vector<std::uint8_t> sites(static_cast<std::size_t>(width * height));
            for (std::uint8_t& site : sites) site = random.uniform() < density;
            const std::vector<std::int32_t> nearest = nearest_sites(width, height, sites);
            for (std::int32_t i = 0; i < width * height; ++i) {
                float best = std::numeric_limits<float>::max();
                for (std::int32_t k = 0; k < width * height; ++k)
                    if (sites[static_cast<std::size_t>(k)]) best = std::min(best, pixel_distance(i, k, width));
                const std::int32_t found = nearest[static_cast<std::size_t>(i)];
                if (best == std::numeric_limits<float>::max()) {
                    EXPECT_EQ(found, k_no_site);
                } else {
                    ASSERT_NE(found, k_no_site);
                    EXPECT_TRUE(sites[static_cast<std::size_t>(found)]);
                    EXPECT_EQ(pixel_distance(i, found, width), best);
                }
            }
        }
    }
}

TEST(GaussianBlur, KeepsConstantsAndSpreadsByItsWidth) {
    const FloatImage constant = gaussian_blur(FloatImage(20, 15, 1, 0.7f), 3);
    for (const float value : constant.data) EXPECT_NEAR(value, 0.7f, 1e-5);
    FloatImage point(61, 61, 1);
    point.pixel(30, 30)[0] = 1;
    const FloatImage spread = gaussian_blur(point, 2.5f);
    double sum = 0, squares = 0;
    for (int y = 0; y < 61; ++y)
        for (int x = 0; x < 61; ++x) {
            sum += static_cast<double>(spread.pixel(x, y)[0]);
            squares += static_cast<double>(spread.pixel(x, y)[0]) * (x - 30) * (x - 30);
        }
    EXPECT_NEAR(sum, 1, 1e-4);
    EXPECT_NEAR(std::sqrt(squares / sum), 2.5, 0.05);
}

TEST(GaussianGradient, OfThinLinesIsAcrossThem) {
    for (const float angle : {0.0f, 0.3f, 0.7f, 1.2f}) {
        const Vec2 along = test::direction(angle), center(20.3f, 19.8f);
        const std::vector<test::InkStroke> line{{{center - 40 * along, center + 40 * along}, 1.5f, 1}};
        const ImageGradient gradient = gaussian_gradient(test::ink_drawing(line, 40, 40), 1);
        double xx = 0, xy = 0, yy = 0;
        for (int y = 8; y < 32; ++y)
            for (int x = 8; x < 32; ++x) {
                const auto gx = static_cast<double>(gradient.x.pixel(x, y)[0]);
                const auto gy = static_cast<double>(gradient.y.pixel(x, y)[0]);
                xx += gx * gx, xy += gx * gy, yy += gy * gy;
            }
        const double across = 0.5 * std::atan2(2 * xy, xx - yy);
        EXPECT_NEAR(std::remainder(across - static_cast<double>(angle) - test::k_pi / 2, test::k_pi), 0, 0.01) << angle;
    }
}

TEST(Regions, AreClosedFilledAndMeasured) {
    PixelMask region(50, 40, 1);
    for (int y = 5; y < 35; ++y)
        for (int x = 5; x < 45; x += x % 8 == 4 ? 5 : 1) region.pixel(x, y)[0] = 1;  // bars with gaps of four
    const PixelMask closed = closed_region(region, 3);
    for (int y = 7; y < 33; ++y)  // not where a disc of three pixels reaches between the ends of bars
        for (int x = 6; x < 43; ++x) EXPECT_TRUE(closed.pixel(x, y)[0]) << x << ", " << y;
    EXPECT_FALSE(closed.pixel(20, 4)[0]);
    PixelMask ring(20, 20, 1);
    for (int k = 4; k < 15; ++k)
        ring.pixel(k, 4)[0] = ring.pixel(k, 14)[0] = ring.pixel(4, k)[0] = ring.pixel(14, k)[0] = 1;
    const PixelMask full = without_holes(ring);
    EXPECT_EQ(std::count(full.data.begin(), full.data.end(), 1), 121);
    EXPECT_EQ(border_points(full, 1000).size(), 40u);
    EXPECT_EQ(border_points(full, 7).size(), 7u);
    const FloatImage distance = signed_distance(full);
    EXPECT_EQ(distance.pixel(9, 4)[0], -0.5f);
    EXPECT_EQ(distance.pixel(9, 9)[0], -5.5f);
    EXPECT_EQ(distance.pixel(9, 1)[0], 2.5f);
    EXPECT_NEAR(distance_at(distance, {9.5f, 3.0f}), 1, 1e-5);
    EXPECT_NEAR(distance_at(distance, {9.5f, -7.5f}), 11.5f, 1e-5);
    ring.pixel(18, 18)[0] = 1;
    EXPECT_FALSE(without_small_pieces(ring, 0.1f).pixel(18, 18)[0]);
    EXPECT_TRUE(without_small_pieces(ring, 0.01f).pixel(18, 18)[0]);
}

}  // namespace
}  // namespace exemplar
