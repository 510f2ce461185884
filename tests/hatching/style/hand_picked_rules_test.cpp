#include "host/synth/hatching/hand_picked_rules.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/hatching/features/host_tools.h"
#include "tests/support/shapes.h"

namespace exemplar {
namespace {

// On an egg, N.V falls from the middle to the rim: the levels of a drawing come back as a disk and two rings, as many
// pixels of each as the drawing has, whatever pixels of the drawing had them.
TEST(HandPickedRules, GiveEachLevelAsManyPixelsAsTheDrawing) {
    constexpr int k_side = 64;
    const HatchingSurface egg = measure_surface(shapes::transformed(
        shapes::icosphere(3, 1), [](const Vec3& p) { return Vec3(p.x(), 0.8f * p.y(), 0.6f * p.z()); }));
    const HatchingView view{fit_camera(egg.mesh, Vec3::UnitZ(), 1, {.vertical_fov = 0}), Vec3(1, 2, 2) / 3, k_side,
                            k_side};
    HostTools host;
    PixelFeatures pixels(egg, view, host.tools);

    DrawingProperties drawing;
    drawing.width = drawing.height = k_side;
    drawing.level.resize(k_side * k_side);
    drawing.center.resize(k_side * k_side, 1);
    for (std::size_t p = 0; p < k_stroke_properties; ++p)
        drawing.property[p].assign(k_side * k_side, 1.5f + static_cast<float>(p));
    std::array<std::size_t, 3> counts{};
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        const std::size_t level = i % 4 == 0 ? 2 : i % 4 == 1 ? 1 : 0;
        drawing.level[pixels.pixels().pixel[i]] = static_cast<std::uint8_t>(level);
        ++counts[level];
    }

    for (const HandPickedRule& rule : hand_picked_rules()) {
        const HatchingFields fields = hatching_by_hand_picked_rule(rule, pixels, drawing);
        std::array<std::size_t, 3> found{};
        std::array<double, 3> radius{};
        for (const std::uint32_t pixel : pixels.pixels().pixel) {
            const std::uint32_t column = pixel % k_side, row = pixel / k_side;
            const double x = static_cast<double>(column) + 0.5 - k_side / 2.0,
                         y = static_cast<double>(row) + 0.5 - k_side / 2.0;
            const std::size_t level = fields.level[pixel];
            ++found[level];
            radius[level] += std::hypot(x, y);
            const float across = std::abs(fields.orientation[0][pixel] - fields.orientation[1][pixel]);
            EXPECT_NEAR(across, std::numbers::pi_v<float> / 2, 1e-4f) << rule.name;
        }
        // Pixels without a direction are not hatched.
        EXPECT_LE(found[2], counts[2]) << rule.name;
        EXPECT_GE(static_cast<double>(found[2] + found[1]), 0.95 * static_cast<double>(counts[2] + counts[1]))
            << rule.name;
        for (std::size_t level = 0; level < 3; ++level) radius[level] /= static_cast<double>(found[level]);
        EXPECT_LT(radius[0], radius[1]) << rule.name;
        EXPECT_LT(radius[1], radius[2]) << rule.name;
        EXPECT_EQ(fields.thickness[0], 1.5f) << rule.name;
        EXPECT_EQ(fields.spacing[0], 1.5f + static_cast<float>(StrokeProperty::spacing)) << rule.name;
    }
}

}  // namespace
}  // namespace exemplar
