#include "host/hatching/placement/streamlines.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "host/core/errors.h"
#include "host/core/parallel.h"
#include "host/hatching/fields/occlusion_barriers.h"
#include "host/hatching/refinement/stroke_statistics.h"
#include "tests/support/hatching_scenes.h"
#include "tests/support/stroke_checks.h"

namespace exemplar {
namespace {

using namespace test_support;

std::vector<float> lengths_of(const std::vector<HatchStroke>& strokes) {
    std::vector<float> lengths;
    lengths.reserve(strokes.size());
    for (const HatchStroke& stroke : strokes) lengths.push_back(length_of(stroke));
    std::ranges::sort(lengths);
    return lengths;
}

TEST(Streamlines, FillAParallelFieldEvenly) {
    const StrokeOptions options;
    for (const float orientation : {0.0f, 0.37f, 1.0f, 2.9f}) {
        SCOPED_TRACE(orientation);
        const HatchingFields fields = even_fields(301, 257, orientation);
        const auto strokes = CpuStrokePlacer().place(fields);
        const SpacingMeasure measure = measure_spacing(strokes, fields);
        EXPECT_GT(measure.gaps, 10000u);
        EXPECT_LT(measure.median_error, 0.02);
        EXPECT_GE(measure.min_ratio, options.test_distance - 0.005);
        EXPECT_LT(empty_share(strokes, fields, 0, 1.0f), 0.002);
        const float tangent = std::tan(orientation);
        for (const HatchStroke& stroke : strokes) {
            const Vec2 way = stroke.points.back() - stroke.points.front();
            EXPECT_NEAR(way.y(), tangent * way.x(), 0.01f * way.norm());
        }
    }
}

TEST(Streamlines, FollowCircles) {
    const HatchingFields fields = circle_fields(300, 300);
    const auto strokes = CpuStrokePlacer().place(fields);
    EXPECT_LT(measure_spacing(strokes, fields).median_error, 0.05);
    EXPECT_LT(empty_share(strokes, fields, 0, 1.2f), 0.002);
    for (const HatchStroke& stroke : strokes) {
        const float radius = (stroke.points[0] - Vec2(150, 150)).norm();
        // In the middle directions between pixels are not those of circles.
        if (radius < 12) continue;
        for (const Vec2& point : stroke.points) EXPECT_NEAR((point - Vec2(150, 150)).norm(), radius, 0.02f * 60);
    }
}

TEST(Streamlines, FollowASpacingThatVaries) {
    HatchingFields fields = even_fields(600, 300, 0.9f);
    for_pixels(fields, [&](std::size_t i, float x, float) { fields.spacing[i] = 4 + 8 * x / 600; });
    const auto strokes = CpuStrokePlacer().place(fields);
    const SpacingMeasure measure = measure_spacing(strokes, fields);
    EXPECT_LT(measure.median_error, 0.1);
    EXPECT_NEAR(measure.mean_ratio, 1, 0.15);
    EXPECT_LT(empty_share(strokes, fields, 0, 1.2f), 0.005);
}

/// Distances to strokes are kept in few bits for the largest spacing of a picture: that one pixel asks for far more
/// than the others leaves them as they are.
TEST(Streamlines, TakeOnePixelOfLongSparseStrokes) {
    const HatchingFields usual = wavy_fields(150, 120, 3);
    const auto count = static_cast<double>(CpuStrokePlacer().place(usual).size());
    for (const float spacing : {40.0f, 128.0f, 256.0f}) {
        SCOPED_TRACE(spacing);
        HatchingFields fields = usual;
        fields.spacing[fields.index(75, 60)] = spacing;
        fields.length[fields.index(75, 60)] = 4 * spacing;
        const auto strokes = CpuStrokePlacer().place(fields);
        EXPECT_NEAR(static_cast<double>(strokes.size()), count, 0.1 * count);
        EXPECT_LT(measure_spacing(strokes, fields).median_error, 0.15);
    }
}

TEST(Streamlines, KeepToTheirLevels) {
    HatchingFields fields = even_fields(240, 240, 0.4f);
    for_pixels(fields, [&](std::size_t i, float x, float y) {
        const float off = std::hypot(std::fmod(x, 80.0f) - 40, std::fmod(y, 80.0f) - 40);
        fields.level[i] = off < 16 ? k_no_hatching : off < 28 ? k_cross_hatching : k_single_hatching;
    });
    const auto strokes = CpuStrokePlacer().place(fields);
    std::array<std::size_t, k_hatch_layers> count{};
    for (const HatchStroke& stroke : strokes) {
        ++count[stroke.layer];
        for (const Vec2& point : stroke.points) ASSERT_GT(fields.level[pixel_of(fields, point)], stroke.layer);
    }
    EXPECT_GT(count[0], 100u);
    EXPECT_GT(count[1], 30u);
    EXPECT_LT(empty_share(strokes, fields, 0, 1.5f), 0.01);
    EXPECT_LT(empty_share(strokes, fields, 1, 1.5f), 0.05);
}

TEST(Streamlines, EndAtBarriers) {
    const HatchingFields fields = even_fields(200, 150, 0.3f);
    std::vector<std::uint8_t> barriers(fields.size());
    for (int y = 0; y < 150; ++y) barriers[fields.index(99, y)] = k_barrier_right;
    // A diagonal one, with steps.
    for (int y = 0; y < 150; ++y) {
        barriers[fields.index(20 + y / 3, y)] |= k_barrier_right;
        if (y % 3 == 2) barriers[fields.index(21 + y / 3, y)] |= k_barrier_below;
    }
    std::size_t near = 0;
    for (const HatchStroke& stroke : CpuStrokePlacer().place(fields, barriers, {.test_distance = 0.7f})) {
        const auto side = [](const Vec2& at) {
            return at.x() >= 100 ? 2 : at.x() >= std::floor(std::floor(at.y()) / 3) + 21 ? 1 : 0;
        };
        for (const Vec2& point : stroke.points) {
            ASSERT_EQ(side(point), side(stroke.points[0])) << point.transpose();
            near += std::abs(point.x() - 100) < 2;
        }
    }
    EXPECT_GT(near, 30u);
}

TEST(Streamlines, EndWhereOrientationsJump) {
    HatchingFields fields = even_fields(200, 200, 0.4f);
    for_pixels(fields, [&](std::size_t i, float x, float) {
        if (x > 100) fields.orientation[0][i] = 1.9f;
    });
    const auto strokes = CpuStrokePlacer().place(fields);
    for (const HatchStroke& stroke : strokes) {
        const Vec2 way = (stroke.points.back() - stroke.points.front()).normalized();
        const float first = std::abs(way.dot(Vec2(std::cos(0.4f), std::sin(0.4f))));
        const float second = std::abs(way.dot(Vec2(std::cos(1.9f), std::sin(1.9f))));
        EXPECT_GT(std::max(first, second), 0.99f);
    }
    EXPECT_LT(empty_share(strokes, fields, 0, 1.2f), 0.01);
}

TEST(Streamlines, AreAsLongAsTheyAreToBe) {
    const HatchingFields fields = even_fields(400, 300, 0.8f, 6, 50);
    for (const float jitter : {0.0f, 0.1f, 0.3f}) {
        const auto lengths = lengths_of(CpuStrokePlacer().place(fields, {}, {.length_jitter = jitter}));
        EXPECT_LE(lengths.back(), 50 * (1 + jitter) + 0.1f);
        EXPECT_NEAR(lengths[lengths.size() / 2], 50, 50 * jitter + 5);
        EXPECT_GE(lengths.front(), 5);
    }
}

TEST(Streamlines, VaryInLengthAcrossThePicture) {
    HatchingFields fields = even_fields(400, 200, 1.5f);
    for_pixels(fields, [&](std::size_t i, float x, float) { fields.length[i] = x < 200 ? 15.0f : 80.0f; });
    float longest = 0;
    for (const HatchStroke& stroke : CpuStrokePlacer().place(fields))
        if (stroke.points.front().x() < 170)
            EXPECT_LE(length_of(stroke), 15 * 1.1f + 0.1f);
        else
            longest = std::max(longest, length_of(stroke));
    EXPECT_GT(longest, 75);
}

/// Where strokes end in a row, the gaps at their ends make lines of their own.
TEST(Streamlines, DoNotEndInLine) {
    const float orientation = 0.37f;
    const Vec2 along(std::cos(orientation), std::sin(orientation)), across(-along.y(), along.x());
    const HatchingFields fields = even_fields(400, 400, orientation);
    std::vector<Vec2> gaps;
    for (const HatchStroke& stroke : CpuStrokePlacer().place(fields)) {
        const bool forward = (stroke.points.back() - stroke.points.front()).dot(along) > 0;
        const Vec2 gap = (forward ? stroke.points.back() : stroke.points.front()) + 2.5f * along;
        if (gap.minCoeff() > 10 && gap.maxCoeff() < 390) gaps.push_back(gap);
    }
    std::size_t in_line = 0;
    for (const Vec2& gap : gaps)
        in_line += std::ranges::any_of(gaps, [&](const Vec2& other) {
            const Vec2 way = other - gap;
            return std::abs(way.dot(along)) < 2.5f && std::abs(std::abs(way.dot(across)) - 6) < 1;
        });
    // By chance alone it were 2 x 5 / 64 of them.
    EXPECT_GT(gaps.size(), 300u);
    EXPECT_LT(static_cast<double>(in_line), 0.12 * static_cast<double>(gaps.size()));
}

TEST(Streamlines, DoNotComeBackToThemselves) {
    const HatchingFields fields = circle_fields(160, 160, 1000);
    float longest = 0;
    for (const HatchStroke& stroke : CpuStrokePlacer().place(fields)) {
        longest = std::max(longest, length_of(stroke));
        for (std::size_t i = 0; i < stroke.points.size(); ++i)
            for (std::size_t j = i + 8; j < stroke.points.size(); ++j)
                ASSERT_GT((stroke.points[i] - stroke.points[j]).norm(), 0.65f * 6);
    }
    EXPECT_GT(longest, 300);
}

TEST(Streamlines, FillNarrowPlacesWithShortStrokes) {
    HatchingFields fields = even_fields(200, 200, std::numbers::pi_v<float> / 2);
    for_pixels(fields, [&](std::size_t i, float, float y) {
        if (y < 90 || y >= 100) fields.level[i] = k_no_hatching;
    });
    const auto strokes = CpuStrokePlacer().place(fields);
    EXPECT_NEAR(static_cast<double>(strokes.size()), 200.0 / 6, 3);
    EXPECT_GT(lengths_of(strokes).front(), 7);
}

TEST(Streamlines, HaveTheLookOfTheirPlace) {
    HatchingFields fields = even_fields(200, 120, 0.2f);
    for_pixels(fields, [&](std::size_t i, float x, float) {
        fields.thickness[i] = 1 + 0.01f * x;
        fields.intensity[i] = x < 100 ? 0.5f : 0.75f;
    });
    for (const HatchStroke& stroke : CpuStrokePlacer().place(fields)) {
        ASSERT_GE(stroke.points.size(), 2u);
        ASSERT_EQ(stroke.points.size(), stroke.widths.size());
        for (std::size_t i = 0; i < stroke.points.size(); ++i) {
            const float x = std::clamp(stroke.points[i].x(), 0.5f, 199.5f);
            EXPECT_NEAR(stroke.widths[i], 1 + 0.01f * x, 1e-4f);
            EXPECT_LE((stroke.points[i] - stroke.points[i ? i - 1 : 0]).norm(), 2.001f);
        }
        const float first = std::min(stroke.points.front().x(), stroke.points.back().x());
        const float last = std::max(stroke.points.front().x(), stroke.points.back().x());
        if (last < 99 || first > 101) {
            EXPECT_FLOAT_EQ(stroke.darkness, last < 99 ? 0.5f : 0.75f);
        }
    }
}

TEST(Streamlines, AreTheSameOnAnyNumberOfThreads) {
    const HatchingFields fields = wavy_fields(331, 257, 5, 0.3f);
    std::vector<std::vector<HatchStroke>> results;
    for (const std::size_t threads : {1u, 2u, 5u}) {
        const ThreadLimit limit(threads);
        results.push_back(CpuStrokePlacer().place(fields));
    }
    EXPECT_GT(results[0].size(), 500u);
    EXPECT_EQ(results[0], results[1]);
    EXPECT_EQ(results[0], results[2]);
}

TEST(Streamlines, FollowTheSeed) {
    const HatchingFields fields = even_fields(120, 120, 0.5f);
    const auto first = CpuStrokePlacer().place(fields, {}, {.seed = 1});
    EXPECT_EQ(first, CpuStrokePlacer().place(fields, {}, {.seed = 1}));
    EXPECT_NE(first, CpuStrokePlacer().place(fields, {}, {.seed = 2}));
    EXPECT_NE(first, CpuStrokePlacer().place(fields, {}, {.seed = std::uint64_t{1} << 40 | 1}));
}

TEST(Streamlines, TakeWhatIsHardlyThere) {
    CpuStrokePlacer placer;
    EXPECT_TRUE(placer.place(HatchingFields()).empty());
    EXPECT_TRUE(placer.place(HatchingFields(40, 30)).empty());
    EXPECT_TRUE(placer.place(even_fields(1, 1, 0.3f)).empty());
    HatchingFields nothing(20, 20);
    std::ranges::fill(nothing.level, k_cross_hatching);
    const auto dense = placer.place(nothing);
    for (const HatchStroke& stroke : dense) EXPECT_LE(length_of(stroke), 4);
    // Denser than pixels: as dense as strokes get.
    EXPECT_EQ(placer.place(even_fields(30, 30, 0.3f, 0.2f, 10)), placer.place(even_fields(30, 30, 0.3f, 1, 10)));
    const HatchingFields fine = even_fields(60, 60, 0.3f, 1.6f, 10);
    EXPECT_GE(measure_spacing(placer.place(fine), fine).min_ratio, 0.65);
    // Two pixels of strokes that are to have no length.
    HatchingFields two = even_fields(40, 30, 0, 6, 0);
    for_pixels(two, [&](std::size_t i, float x, float y) {
        if (y != 15.5f || (x != 20.5f && x != 21.5f)) two.level[i] = k_no_hatching;
    });
    for (const HatchStroke& stroke : placer.place(two)) EXPECT_LE(length_of(stroke), 2);
    // Sparser than the picture.
    EXPECT_LE(placer.place(even_fields(50, 50, 0.3f, 2000, 1e9f)).size(), 1u);
    EXPECT_GE(placer.place(even_fields(9, 300, 0.1f, 5, 100)).size(), 40u);
}

TEST(Streamlines, RefuseTargetsThatMeanNothing) {
    CpuStrokePlacer placer;
    const float bad[] = {-1, std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()};
    for (const float value : bad) {
        for (auto member : {&HatchingFields::thickness, &HatchingFields::spacing, &HatchingFields::length,
                            &HatchingFields::intensity}) {
            HatchingFields fields = even_fields(8, 8, 0);
            (fields.*member)[17] = value;
            EXPECT_THROW(placer.place(fields), UsageError);
            // What is not hatched has no targets.
            fields.level[17] = k_no_hatching;
            EXPECT_NO_THROW(placer.place(fields));
        }
    }
    HatchingFields fields = even_fields(8, 8, 0);
    fields.orientation[0][3] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THROW(placer.place(fields), UsageError);
    fields = even_fields(8, 8, 0);
    fields.intensity[3] = 1.5f;
    EXPECT_THROW(placer.place(fields), UsageError);
    fields = even_fields(8, 8, 0);
    fields.level[3] = 3;
    EXPECT_THROW(placer.place(fields), UsageError);
    fields = even_fields(8, 8, 0);
    fields.length.pop_back();
    EXPECT_THROW(placer.place(fields), UsageError);
    EXPECT_THROW(placer.place(even_fields(8, 8, 0), std::vector<std::uint8_t>(63)), UsageError);
    EXPECT_THROW(placer.place(even_fields(40000, 1, 0)), UsageError);
}

TEST(Streamlines, RefuseOptionsOutOfRange) {
    const HatchingFields fields = even_fields(8, 8, 0);
    const auto refused = [&](const StrokeOptions& options) {
        EXPECT_THROW(CpuStrokePlacer().place(fields, {}, options), UsageError);
    };
    constexpr float k_nan = std::numeric_limits<float>::quiet_NaN();
    for (const float value : {0.0f, 1.0f, k_nan}) refused({.test_distance = value});
    for (const float value : {-0.1f, 1.1f, k_nan}) refused({.min_length = value});
    for (const float value : {-0.1f, 0.6f, k_nan}) refused({.length_jitter = value});
    for (const float value : {0.0f, 2.0f, k_nan}) refused({.max_turn = value});
    for (const float value : {-0.1f, k_nan}) refused({.length_hysteresis = value});
    for (const float value : {0.0f, 2.0f, k_nan}) refused({.max_deviation = value});
}

}  // namespace
}  // namespace exemplar
