#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "gpu/hatching/stroke_placer.h"
#include "gpu/runtime/vulkan/errors.h"
#include "host/core/errors.h"
#include "host/hatching/fields/occlusion_barriers.h"
#include "tests/gpu/support/environment.h"
#include "tests/support/hatching_scenes.h"

// Strokes are placed in whole numbers, so that the device's are the very same as the reference's: nothing is tolerated.
namespace exemplar {
namespace {

using namespace test_support;

std::vector<std::uint8_t> random_barriers(const HatchingFields& fields, std::uint64_t seed) {
    Random random(seed);
    std::vector<std::uint8_t> barriers(fields.size());
    const int column = fields.width / 3;
    for (int y = 0; y < fields.height; ++y) barriers[fields.index(column, y)] = k_barrier_right;
    for (std::uint8_t& bits : barriers)
        if (random.uniform() < 0.002) bits = static_cast<std::uint8_t>(random.index(4));
    return barriers;
}

class StrokePlacement : public ::testing::Test {
  protected:
    CpuStrokePlacer host_;
    GpuStrokePlacer device_{shared_device()};

    void expect_same(const HatchingFields& fields, std::span<const std::uint8_t> barriers = {},
                     const StrokeOptions& options = {}, std::span<const HatchStroke> kept = {}) {
        // Some devices see few texels at once; others take all pictures of these tests.
        if (2 * fields.size() > shared_device().info().max_texels) return;
        const auto expected = host_.place(fields, barriers, options, kept);
        const auto actual = device_.place(fields, barriers, options, kept);
        ASSERT_EQ(actual.size(), expected.size());
        for (std::size_t i = 0; i < actual.size(); ++i) ASSERT_EQ(actual[i], expected[i]) << "stroke " << i;
    }
};

TEST_F(StrokePlacement, FindsTheSameStrokesInRandomPictures) {
    for (const std::uint64_t seed : {1u, 2u, 3u, 4u, 5u, 6u}) {
        SCOPED_TRACE(seed);
        const HatchingFields fields = wavy_fields(131 + 40 * static_cast<int>(seed), 190, seed, seed % 2 ? 0.0f : 0.5f);
        expect_same(fields, random_barriers(fields, seed), {.seed = seed});
    }
}

TEST_F(StrokePlacement, FindsTheSameStrokesWhateverTheOptions) {
    const HatchingFields fields = wavy_fields(160, 140, 9);
    for (const StrokeOptions& options :
         {StrokeOptions{.test_distance = 0.3f}, StrokeOptions{.test_distance = 0.95f}, StrokeOptions{.min_length = 0},
          StrokeOptions{.min_length = 1, .length_jitter = 0}, StrokeOptions{.length_jitter = 0.5f},
          StrokeOptions{.max_turn = 0.05f}, StrokeOptions{.max_turn = 1.5f}})
        expect_same(fields, {}, options);
}

TEST_F(StrokePlacement, TakesPicturesOfAnySize) {
    for (const int width : {0, 1, 2, 63, 64, 65})
        for (const int height : {1, 7, 33}) expect_same(even_fields(width, height, 0.6f, 3, 20));
    expect_same(HatchingFields(50, 50));
    expect_same(even_fields(900, 3, 0.02f, 2, 300));
}

TEST_F(StrokePlacement, TurnsInCirclesAndEndsBeforeItself) {
    expect_same(circle_fields(200, 200, 1000));
    expect_same(circle_fields(101, 77, 30));
}

TEST_F(StrokePlacement, TakesSparseAndDenseStrokes) {
    expect_same(even_fields(400, 300, 0.8f, 37, 150));
    expect_same(even_fields(60, 40, 0.8f, 0.5f, 7));
    expect_same(even_fields(200, 200, 0.8f, 500, 2000));
}

/// Long targets in a narrow place: many more strokes than their targets tell, so that rooms must grow.
/// Far more workgroups share the strokes than devices must take in a row.
TEST_F(StrokePlacement, TakesPicturesWithOnePixelOfLongSparseStrokes) {
    HatchingFields fields = wavy_fields(150, 120, 3);
    fields.spacing[fields.index(75, 60)] = 256;
    fields.length[fields.index(75, 60)] = 1024;
    expect_same(fields);
}

TEST_F(StrokePlacement, GrowsWhereThereAreMoreStrokesThanExpected) {
    HatchingFields fields = even_fields(1200, 1200, 1.57f, 2, 1000);
    for_pixels(fields, [&](std::size_t i, float, float y) {
        if (std::fmod(y, 8.0f) > 5) fields.level[i] = k_no_hatching;
    });
    expect_same(fields);
}

TEST_F(StrokePlacement, KeepsTheSameStrokes) {
    const HatchingFields fields = wavy_fields(230, 190, 12);
    auto kept = host_.place(fields);
    for (HatchStroke& stroke : kept)
        for (Vec2& point : stroke.points) point += Vec2(1.7f, -0.9f + 0.01f * point.x());
    HatchingFields later = fields;
    for_pixels(later, [&](std::size_t i, float x, float) {
        if (x > 180) later.level[i] = k_no_hatching;
        later.length[i] *= 0.9f;
    });
    expect_same(later, random_barriers(later, 4), {}, kept);
}

TEST_F(StrokePlacement, IsTheSameOnEveryRun) {
    const HatchingFields fields = wavy_fields(180, 180, 20, 0.2f);
    const auto first = device_.place(fields);
    EXPECT_GT(first.size(), 200u);
    for (int i = 0; i < 3; ++i) {
        device_.place(even_fields(40 + 100 * i, 90, 0.3f));
        EXPECT_EQ(device_.place(fields), first);
        EXPECT_EQ(GpuStrokePlacer(shared_device()).place(fields), first);
    }
}

TEST_F(StrokePlacement, RefusesWhatTheReferenceRefuses) {
    HatchingFields fields = even_fields(8, 8, 0);
    fields.spacing[5] = -1;
    EXPECT_THROW(device_.place(fields), UsageError);
    EXPECT_THROW(device_.place(even_fields(8, 8, 0), {}, {.test_distance = 2}), UsageError);
    EXPECT_FALSE(device_.place(even_fields(40, 40, 0)).empty());
}

}  // namespace
}  // namespace exemplar
