#include "host/hatching/style/style_prediction.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <string>

#include "host/hatching/style/hatching_style.h"
#include "tests/hatching/features/host_tools.h"
#include "tests/support/shapes.h"

namespace exemplar {
namespace {

std::uint32_t field_of(const std::string& name) {
    const auto& names = orientation_feature_names();
    return static_cast<std::uint32_t>(std::ranges::find(names, name) - names.begin());
}

/// One class is likelier than the others everywhere.
CalibratedStumps always(std::uint32_t classes, std::uint32_t likely) {
    CalibratedStumps result;
    result.stumps.class_count = classes;
    result.stumps.stumps = {{0, -1e30f, 5, 5, std::uint64_t{1} << likely}};
    result.stumps.elsewhere.assign(classes, -5);
    result.stumps.elsewhere[likely] = 0;
    return result;
}

/// Cross-hatches everything along one field, and across it.
HatchingStyle everywhere_along(const std::string& field) {
    HatchingStyle style;
    style.rules.resize(1);
    style.rules[0].function[0].terms = {{field_of(field), 1.0f}};
    style.rules[0].function[1].terms = {{field_of("perp " + field), 1.0f}};
    style.share = {1};
    style.segments = {always(1, 0)};
    style.boundary = always(2, 0);
    style.levels = always(3, k_cross_hatching);
    for (PropertyModel& property : style.properties) property.factor = 2;
    return style;
}

HatchingFields predicted(const HatchingStyle& style, const HatchingSurface& surface, const Vec3& from) {
    const HatchingView view{fit_camera(surface.mesh, from, 1, {.vertical_fov = 0}), Vec3(1, 2, 2) / 3, 60, 60};
    HostTools host;
    PixelFeatures pixels(surface, view, host.tools);
    CpuStumpScorer scorer;
    CpuHatchingEvaluator evaluator;
    return predict_hatching(style, pixels, scorer, evaluator).fields;
}

// A sheet seen from above has the same shading all over: no gradient, and nothing that strokes could follow.
TEST(PredictHatching, HatchesOnlyWhereThereIsADirection) {
    const HatchingSurface sheet = measure_surface(shapes::grid(8, 8, 1));
    const Vec3 above = sheet.normals[0];
    const auto hatched = [&](const char* field, std::uint8_t level) {
        const HatchingFields fields = predicted(everywhere_along(field), sheet, above);
        return std::ranges::count(fields.level, level);
    };
    EXPECT_EQ(hatched("grad V.N,1", k_no_hatching), 60 * 60);
    EXPECT_GT(hatched("L", k_cross_hatching), 40 * 40);
}

}  // namespace
}  // namespace exemplar
