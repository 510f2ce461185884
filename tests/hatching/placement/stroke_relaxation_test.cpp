#include "host/hatching/refinement/stroke_relaxation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "host/core/errors.h"
#include "host/core/parallel.h"
#include "host/hatching/placement/stroke_gaps.h"
#include "host/hatching/refinement/stroke_statistics.h"
#include "tests/support/hatching_scenes.h"

namespace exemplar {
namespace {

using namespace test_support;

/// Strokes from left to right at some heights of a picture.
std::vector<HatchStroke> rows(const std::vector<float>& heights, float from = 10, float to = 90) {
    std::vector<HatchStroke> strokes;
    for (const float y : heights) {
        HatchStroke stroke;
        for (float x = from; x <= to; ++x) {
            stroke.points.emplace_back(x, y);
            stroke.widths.push_back(1);
        }
        strokes.push_back(stroke);
    }
    return strokes;
}

float height_of(const HatchStroke& stroke) {
    return stroke.points[stroke.points.size() / 2].y();
}

TEST(StrokeGaps, AreThoseToTheNextStrokes) {
    const HatchingFields fields = even_fields(100, 100, 0, 6);
    const auto strokes = rows({20, 26, 35, 80});
    const StrokeGaps gaps(strokes, fields);
    for (const auto& beside : gaps.beside(1)) {
        EXPECT_EQ(beside.spacing, 6);
        EXPECT_NEAR(std::abs(beside.across.y()), 1, 1e-6);
        const std::size_t down = beside.across.y() > 0 ? 0 : 1;
        EXPECT_NEAR(beside.ratio[down], 1.5, 1e-5);
        EXPECT_NEAR(beside.ratio[1 - down], 1, 1e-5);
    }
    // Over three spacings away there is nothing.
    for (const auto& beside : gaps.beside(3))
        EXPECT_EQ(std::ranges::count(beside.ratio, StrokeGaps::k_invalid_index), 2);
    EXPECT_FLOAT_EQ(gaps.least(0), 1);
    const auto near = rows({20, 23});
    EXPECT_NEAR(StrokeGaps(near, fields).least(1), 0.5, 1e-5);
}

TEST(StrokeGaps, DoNotLookAcrossWhatIsEmptyOrOfAnotherLayer) {
    HatchingFields fields = even_fields(100, 100, 0, 6);
    for (int x = 0; x < 100; ++x) fields.level[fields.index(x, 23)] = k_no_hatching;
    auto strokes = rows({20, 26, 32});
    strokes[2].layer = 1;
    for (auto& level : fields.level) level = level ? k_cross_hatching : k_no_hatching;
    const StrokeGaps gaps(strokes, fields);
    for (std::uint32_t i = 0; i < 3; ++i)
        for (const auto& beside : gaps.beside(i))
            EXPECT_EQ(std::ranges::count(beside.ratio, StrokeGaps::k_invalid_index), 2) << i;
}

TEST(StrokeGaps, RefuseLayersThatAreNot) {
    auto strokes = rows({20});
    strokes[0].layer = 2;
    EXPECT_THROW(StrokeGaps(strokes, even_fields(100, 100, 0)), UsageError);
    EXPECT_THROW(relax_spacing(strokes, even_fields(100, 100, 0)), UsageError);
    EXPECT_THROW(relax_spacing({}, even_fields(100, 100, 0), -1), UsageError);
}

TEST(RelaxSpacing, EvensGapsOut) {
    const HatchingFields fields = even_fields(100, 100, 0, 6);
    auto strokes = rows({20, 24.5f, 32, 38, 42, 50});
    relax_spacing(strokes, fields, 60);
    std::ranges::sort(strokes, {}, height_of);
    for (std::size_t i = 0; i + 1 < strokes.size(); ++i)
        EXPECT_NEAR(height_of(strokes[i + 1]) - height_of(strokes[i]), 6, 0.4) << i;
}

TEST(RelaxSpacing, TurnsStrokesThatAreAskew) {
    const HatchingFields fields = even_fields(100, 100, 0, 6);
    auto strokes = rows({20, 26, 32});
    for (Vec2& point : strokes[1].points) point.y() += 0.03f * (point.x() - 50);
    const double before = measure_spacing(strokes, fields).median_error;
    relax_spacing(strokes, fields, 60);
    EXPECT_LT(measure_spacing(strokes, fields).median_error, 0.2 * before);
}

TEST(RelaxSpacing, MovesNothingFarOrOutOfItsLayer) {
    HatchingFields fields = even_fields(100, 100, 0, 6);
    auto far = rows({20, 22});
    relax_spacing(far, fields, 100);
    EXPECT_NEAR(height_of(far[0]), 20 - 0.3f * 6, 0.01);
    EXPECT_NEAR(height_of(far[1]), 22 + 0.3f * 6, 0.01);
    // What is a hole is left to other strokes.
    auto holed = rows({20, 32});
    const auto as_it_was = holed;
    relax_spacing(holed, fields, 100);
    EXPECT_EQ(holed, as_it_was);
    for (int x = 0; x < 100; ++x) fields.level[fields.index(x, 19)] = k_no_hatching;
    auto border = rows({20.3f, 23});
    relax_spacing(border, fields, 100);
    EXPECT_GE(height_of(border[0]), 20);
}

TEST(RelaxSpacing, TakesWhatIsHardlyThere) {
    const HatchingFields fields = even_fields(20, 20, 0);
    relax_spacing({}, fields);
    std::vector<HatchStroke> strokes{{0, {Vec2(5, 5)}, {1}, 1}, {0, {Vec2(8, 8), Vec2(8, 8)}, {1, 1}, 1}};
    const auto as_they_were = strokes;
    relax_spacing(strokes, fields);
    EXPECT_EQ(strokes, as_they_were);
    relax_spacing(strokes, fields, 0);
    EXPECT_EQ(strokes, as_they_were);
}

/// A damaged style may ask for anything; strokes are as far apart as they get.
TEST(RelaxSpacing, EndsWhateverTheSpacing) {
    for (const float spacing : {1e5f, 1e9f, 1e30f}) {
        std::vector<HatchStroke> strokes{{0, {Vec2(5, 25), Vec2(45, 25)}, {1, 1}, 1}};
        const auto as_they_were = strokes;
        relax_spacing(strokes, even_fields(50, 50, 0, spacing));
        EXPECT_EQ(strokes, as_they_were);
    }
}

class PlaceEvenly : public ::testing::TestWithParam<int> {};

TEST_P(PlaceEvenly, SpacesStrokesBetterAndKeepsAllElse) {
    const HatchingFields fields = wavy_fields(300, 220, static_cast<std::uint64_t>(GetParam()));
    CpuStrokePlacer placer;
    const StrokeOptions options;
    const auto placed = placer.place(fields), even = place_evenly(placer, fields, {}, options);
    const SpacingMeasure before = measure_spacing(placed, fields), after = measure_spacing(even, fields);
    EXPECT_LT(after.median_error, 0.85 * before.median_error);
    EXPECT_GT(after.gaps, 0.9 * static_cast<double>(before.gaps));
    EXPECT_GE(after.min_ratio, options.test_distance - 0.03);
    for (const HatchStroke& stroke : even)
        for (const Vec2& at : stroke.points)
            ASSERT_GT(fields.level[fields.index(static_cast<int>(at.x()), static_cast<int>(at.y()))], stroke.layer);
}
INSTANTIATE_TEST_SUITE_P(Waves, PlaceEvenly, ::testing::Values(1, 2, 3, 4));

TEST(PlaceEvenly, IsTheSameOnAnyNumberOfThreads) {
    const HatchingFields fields = wavy_fields(201, 157, 5, 0.3f);
    CpuStrokePlacer placer;
    std::vector<std::vector<HatchStroke>> results;
    for (const std::size_t threads : {1u, 2u, 5u}) {
        const ThreadLimit limit(threads);
        results.push_back(place_evenly(placer, fields, {}, {}));
    }
    EXPECT_EQ(results[0], results[1]);
    EXPECT_EQ(results[0], results[2]);
}

}  // namespace
}  // namespace exemplar
