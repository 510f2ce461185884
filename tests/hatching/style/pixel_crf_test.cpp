#include "host/hatching/style/pixel_crf.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

#include "host/core/random.h"

namespace exemplar {
namespace {

constexpr int k_crf_width = 60, k_crf_height = 40;
constexpr std::size_t k_pixels = std::size_t{k_crf_width} * k_crf_height;

std::size_t index(int x, int y) {
    return static_cast<std::size_t>(y) * k_crf_width + static_cast<std::size_t>(x);
}

CoveredPixels pixels_where(const std::function<bool(int, int)>& covered) {
    CoveredPixels pixels;
    pixels.row.assign(k_pixels, -1);
    for (int y = 0; y < k_crf_height; ++y)
        for (int x = 0; x < k_crf_width; ++x) {
            if (!covered(x, y)) continue;
            pixels.row[index(x, y)] = static_cast<std::int32_t>(pixels.pixel.size());
            pixels.pixel.push_back(static_cast<std::uint32_t>(y * k_crf_width + x));
        }
    return pixels;
}
CoveredPixels all_pixels() {
    return pixels_where([](int, int) { return true; });
}

/// Of two labels, the second of which holds from column `border` on; a share of pixels says the opposite.
std::vector<float> two_halves(int border, double wrong, std::uint64_t seed) {
    Random random(seed);
    std::vector<float> probabilities;
    for (int i = 0; i < k_crf_width * k_crf_height; ++i) {
        const bool second = (i % k_crf_width >= border) != (random.uniform() < wrong);
        probabilities.push_back(second ? 0.3f : 0.7f);
        probabilities.push_back(second ? 0.7f : 0.3f);
    }
    return probabilities;
}

/// For each row of pixels where the second label begins; -1 if a row changes its label more than once.
std::vector<int> borders(const std::vector<std::int32_t>& labels) {
    std::vector<int> result;
    for (int y = 0; y < k_crf_height; ++y) {
        int border = 0, changes = 0;
        for (int x = 1; x < k_crf_width; ++x) {
            if (labels[index(x, y)] == labels[index(x - 1, y)]) continue;
            border = x;
            ++changes;
        }
        result.push_back(changes == 1 ? border : -1);
    }
    return result;
}

std::vector<float> evidence(float elsewhere, int border, float there) {
    std::vector<float> boundary(k_pixels, elsewhere);
    for (int y = 0; border > 0 && y < k_crf_height; ++y)
        for (const int x : {border - 1, border}) boundary[index(x, y)] = there;
    return boundary;
}

TEST(PixelCrf, DrawsAStraightBorderBetweenNoisyHalves) {
    const CoveredPixels pixels = all_pixels();
    PixelCrf crf(pixels, k_crf_width, evidence(0.2f, 0, 0));
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        const auto labels = crf.solve(two_halves(27, 0.2, seed), 2, {1.0f, -1.0f});
        for (const int border : borders(labels)) EXPECT_NEAR(border, 27, 1);
    }
}

// With no pairwise term each pixel has its own likeliest label.
TEST(PixelCrf, WithoutStrengthPixelsStandAlone) {
    const CoveredPixels pixels = all_pixels();
    const std::vector<float> probabilities = two_halves(27, 0.2, 1);
    PixelCrf crf(pixels, k_crf_width, evidence(0.2f, 0, 0));
    for (const PixelCrfParameters& parameters : {PixelCrfParameters{0.0f, -1.0f}, PixelCrfParameters{1.0f, 5.0f}}) {
        const auto labels = crf.solve(probabilities, 2, parameters);
        for (std::size_t i = 0; i < labels.size(); ++i)
            ASSERT_EQ(labels[i], probabilities[2 * i + 1] > 0.5f ? 1 : 0) << i;
    }
}

// Between the columns 20 and 40 pixels do not know; the border goes where boundaries are likely.
TEST(PixelCrf, EvidenceOfBoundariesMovesTheBorder) {
    const CoveredPixels pixels = all_pixels();
    std::vector<float> probabilities = two_halves(30, 0, 1);
    for (int i = 0; i < k_crf_width * k_crf_height; ++i) {
        if (i % k_crf_width < 20 || i % k_crf_width >= 40) continue;
        probabilities[2 * static_cast<std::size_t>(i)] = probabilities[2 * static_cast<std::size_t>(i) + 1] = 0.5f;
    }
    for (const int likely : {22, 30, 37}) {
        PixelCrf crf(pixels, k_crf_width, evidence(0.05f, likely, 0.9f));
        const auto labels = crf.solve(probabilities, 2, {1.0f, -1.0f});
        for (const int border : borders(labels)) EXPECT_EQ(border, likely);
    }
}

// A blot of another label stays as long as its pixels say so more loudly than its rim costs.
TEST(PixelCrf, StrengthAndOffsetDropSmallSegments) {
    const CoveredPixels pixels = all_pixels();
    std::vector<float> probabilities;
    for (int i = 0; i < k_crf_width * k_crf_height; ++i) {
        const bool inside = std::hypot(i % k_crf_width - 30, i / k_crf_width - 20) < 4;
        probabilities.push_back(inside ? 0.2f : 0.8f);
        probabilities.push_back(inside ? 0.8f : 0.2f);
    }
    PixelCrf crf(pixels, k_crf_width, evidence(0.3f, 0, 0));
    const auto count = [&](const PixelCrfParameters& parameters) {
        std::size_t inside = 0;
        for (const std::int32_t label : crf.solve(probabilities, 2, parameters)) inside += label == 1;
        return inside;
    };
    EXPECT_GT(count({0.1f, -1.0f}), 40U);
    EXPECT_EQ(count({3.0f, -1.0f}), 0U);
    EXPECT_EQ(count({0.1f, -40.0f}), 0U);
}

// Pixels that do not touch, not even at a corner, do not know of each other.
TEST(PixelCrf, NeighborsAreThoseOfTheObject) {
    const auto inside = [](int x, int y) { return (x < 25 && y < 30) || (x > 26 && y > 5); };
    const CoveredPixels pixels = pixels_where(inside);
    std::vector<float> probabilities, boundary(pixels.pixel.size(), 0.01f);
    for (const std::uint32_t pixel : pixels.pixel) {
        const bool left = pixel % k_crf_width < 25;
        probabilities.push_back(left ? 0.45f : 0.55f);
        probabilities.push_back(left ? 0.55f : 0.45f);
    }
    PixelCrf crf(pixels, k_crf_width, boundary);
    const auto labels = crf.solve(probabilities, 2, {100.0f, -10.0f});
    for (std::size_t i = 0; i < labels.size(); ++i) ASSERT_EQ(labels[i], pixels.pixel[i] % k_crf_width < 25 ? 1 : 0);
}

}  // namespace
}  // namespace exemplar
