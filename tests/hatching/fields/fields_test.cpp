#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "host/hatching/fields/hatching_fields.h"

namespace exemplar {
namespace {

TEST(HatchingFields, DirectionsHaveNoSign) {
    constexpr float k_half_turn = std::numbers::pi_v<float>;
    EXPECT_NEAR(orientation_difference(0.1f, k_half_turn - 0.1f), 0.2f, 1e-6f);
    EXPECT_NEAR(orientation_difference(-3 * k_half_turn, 0.3f), 0.3f, 1e-5f);
    EXPECT_NEAR(orientation_difference(0, k_half_turn / 2), k_half_turn / 2, 1e-6f);
}

}  // namespace
}  // namespace exemplar
