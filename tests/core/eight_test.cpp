#include "host/core/eight.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "host/core/half.h"

namespace exemplar {
namespace {

TEST(Eight, HalvesAreReadAsOneByOne) {
    for (std::uint32_t first = 0; first < 65536; first += 8) {
        std::array<Half, 8> halves;
        for (std::uint32_t i = 0; i < 8; ++i) halves[i].bits = static_cast<std::uint16_t>(first + i);
        const EightFloats values = eight_from_halves(halves.data());
        for (std::size_t i = 0; i < 8; ++i) {
            const float expected = from_half(halves[i]), actual = values[i];
            if (std::isnan(expected))
                ASSERT_TRUE(std::isnan(actual));
            else
                ASSERT_EQ(std::bit_cast<std::uint32_t>(actual), std::bit_cast<std::uint32_t>(expected)) << first + i;
        }
    }
}

TEST(Eight, TransposingTwiceGivesWhatWas) {
    const EightFloats step{0, 1, 2, 3, 4, 5, 6, 7};
    const FourEights columns{step, step + 10, step + 20, step + 30}, rows = transposed(columns);
    // Item 6 and, before it, item 2.
    const EightFloats third{2, 12, 22, 32, 6, 16, 26, 36};
    for (int i = 0; i < 8; ++i) {
        EXPECT_EQ(rows.c[i], third[i]);
        EXPECT_EQ(transposed(rows).b[i], columns.b[i]);
        EXPECT_EQ(transposed(rows).d[i], columns.d[i]);
        EXPECT_EQ(joined(low_half(step), high_half(step))[i], step[i]);
    }
}

TEST(Eight, RootsAndMagnitudesAreThoseOfSingleNumbers) {
    constexpr float k_infinity = std::numeric_limits<float>::infinity();
    const EightFloats x{0.0f, -0.0f, 2.0f, 1e-40f, 3e38f, k_infinity, 0.7f, 1e-20f};
    const EightFloats y{-0.0f, -1.5f, 2.5f, -k_infinity, k_infinity, -1e-40f, 0.0f, -3e38f};
    for (int i = 0; i < 8; ++i) {
        EXPECT_EQ(square_root(x)[i], std::sqrt(x[i]));
        EXPECT_EQ(magnitude(y)[i], std::abs(y[i]));
        EXPECT_FALSE(std::signbit(magnitude(y)[i]));
    }
}

}  // namespace
}  // namespace exemplar
