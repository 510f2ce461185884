#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "host/core/errors.h"
#include "host/core/parallel.h"
#include "host/core/random.h"
#include "host/hatching/drawing/drawing_alignment.h"
#include "host/hatching/drawing/drawing_input.h"
#include "tests/hatching/measurement/test_drawings.h"

namespace exemplar {
namespace {

using namespace test;

constexpr int k_scan_width = 400, k_scan_height = 300;
const Vec2 k_scan_center(205, 155);
using Shape = std::function<bool(const Vec2&)>;  // whether a place relative to the center is inside

bool cow(const Vec2& v) {
    const auto box = [&](float left, float top, float right, float bottom) {
        return v.x() > left && v.x() < right && v.y() > top && v.y() < bottom;
    };
    return Vec2(v.x() / 112, v.y() / 48).norm() < 1 || box(-90, 0, -68, 98) || box(-50, 0, -34, 96) ||
           box(48, 0, 64, 92) || box(76, 0, 92, 95) || (v - Vec2(120, -48)).norm() < 34;
}
bool blob(const Vec2& v) {
    const float a = std::atan2(v.y(), v.x());
    return v.norm() < 100 * (1 + 0.2f * std::sin(2 * a + 0.4f) + 0.12f * std::cos(3 * a) + 0.06f * std::sin(5 * a));
}
bool star(const Vec2& v) {
    return v.norm() < 80 + 50 * std::cos(5 * std::atan2(v.y(), v.x()) + 0.3f);
}

Image mask_of(const Shape& shape) {
    Image mask(k_scan_width, k_scan_height, 1);
    for (int y = 0; y < k_scan_height; ++y)
        for (int x = 0; x < k_scan_width; ++x)
            mask.pixel(x, y)[0] =
                shape(Vec2(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f) - k_scan_center) ? 255 : 0;
    return mask;
}

/// Hatches over the part of a shape that is farther than `lit` towards the lower right of its center.
std::vector<InkStroke> hatches(const Shape& shape, float angle, float spacing, float lit) {
    std::vector<InkStroke> strokes;
    const Vec2 along = direction(angle), across(-along.y(), along.x()), light = direction(0.9f);
    for (int k = -40; k <= 40; ++k) {
        InkStroke stroke{{}, 1.6f, 0.9f};
        for (float t = -250; t <= 250; t += 0.5f) {
            const Vec2 at = t * along + static_cast<float>(k) * spacing * across;
            const bool on = shape(at) && at.dot(light) > lit;
            if (on) stroke.points.push_back(k_scan_center + at);
            if (!on || t == 250) {
                if (stroke.points.size() > 12)
                    strokes.push_back({{stroke.points.front(), stroke.points.back()}, 1.6f, 0.9f});
                stroke.points.clear();
            }
        }
    }
    return strokes;
}

/// A scan of strokes drawn in the view, laid down on paper by a similarity.
Image scan_of(std::vector<InkStroke> strokes, const Similarity& to_paper, int width, int height) {
    for (InkStroke& stroke : strokes) {
        stroke.width *= static_cast<float>(to_paper.scale());
        for (Vec2& point : stroke.points) point = to_paper.apply(point);
    }
    return scanned(ink_drawing(strokes, width, height), {0.5f, 0.02f, 0.93f, 0.06f});
}

/// Root mean square distance, over the object, between where an alignment puts places and where they belong.
double error_of(const Similarity& to_view, const Similarity& to_paper, const Image& mask) {
    double sum = 0;
    int count = 0;
    for (int y = 0; y < mask.height; y += 3)
        for (int x = 0; x < mask.width; x += 3) {
            if (!mask.pixel(x, y)[0]) continue;
            const Vec2 at(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
            sum += static_cast<double>((to_view.apply(to_paper.apply(at)) - at).squaredNorm());
            ++count;
        }
    return std::sqrt(sum / count);
}

/// The view's center goes to that of a sheet of the given size.
Similarity laid_down(double scale, double rotation, int width, int height) {
    const Similarity turned(scale, rotation);
    const Vec2 center = turned.apply({0.5f * k_scan_width, 0.5f * k_scan_height});
    return turned.moved(0.5 * width - static_cast<double>(center.x()), 0.5 * height - static_cast<double>(center.y()));
}

struct AlignmentCase {
    std::string name;
    Shape shape;
    float lit;  ///< pixels from the center, towards the dark side
    double scale, degrees;
    int width, height;
};
void PrintTo(const AlignmentCase& alignment, std::ostream* out) {
    *out << alignment.name;
}

class Alignment : public testing::TestWithParam<AlignmentCase> {};

TEST_P(Alignment, FindsWhereTheDrawingLies) {
    const auto& [name, shape, lit, scale, degrees, width, height] = GetParam();
    const Similarity to_paper = laid_down(scale, degrees * static_cast<double>(k_pi) / 180, width, height);
    const Image mask = mask_of(shape), scan = scan_of(hatches(shape, 0.6f, 7, lit), to_paper, width, height);
    const DrawingAlignment alignment = align_drawing(drawing_darkness(scan), mask);
    EXPECT_LE(error_of(alignment.to_view, to_paper, mask), 1) << name;
    EXPECT_NEAR(alignment.to_view.scale(), 1 / scale, 0.01 / scale);
    EXPECT_LE(alignment.residual, 4);
    EXPECT_GE(alignment.explained, 0.4f);
    EXPECT_LE(alignment.outside, 0.02f);
    EXPECT_FALSE(alignment.same_frame);
}

const auto k_name_of_scan = [](const auto& alignment) { return alignment.param.name; };
INSTANTIATE_TEST_SUITE_P(Scans, Alignment,
                         testing::Values(AlignmentCase{"cow_tilted", cow, -500, 1.6, 7.3, 820, 640},
                                         AlignmentCase{"cow_half_blank", cow, -5, 2.3, -4.1, 1100, 900},
                                         AlignmentCase{"cow_on_its_side", cow, -30, 1.3, 92.5, 700, 760},
                                         AlignmentCase{"cow_upside_down_small", cow, -500, 0.8, 175, 500, 400},
                                         AlignmentCase{"blob_tilted", blob, -500, 1.4, -9.2, 700, 600},
                                         AlignmentCase{"blob_part_blank", blob, -35, 1.9, 3, 900, 800},
                                         AlignmentCase{"star_part_blank", star, -35, 1.2, -5, 700, 500}),
                         k_name_of_scan);

TEST(SameFrame, IsKeptAsItIs) {
    const Image mask = mask_of(blob);
    const Similarity twice(2, 0);
    const Image drawing = scan_of(hatches(blob, 1.1f, 8, -20), twice, 2 * k_scan_width, 2 * k_scan_height);
    const DrawingAlignment alignment = align_drawing(drawing_darkness(drawing), mask);
    EXPECT_TRUE(alignment.same_frame);
    EXPECT_EQ(error_of(alignment.to_view, twice, mask), 0);
}

TEST(SameFrame, IsNotForcedUponAScanOfTheSameShape) {
    const Image mask = mask_of(cow);
    const Similarity to_paper = laid_down(0.8, 0.1, k_scan_width, k_scan_height).moved(20, -12);
    const Image scan = scan_of(hatches(cow, 0.6f, 8, -500), to_paper, k_scan_width, k_scan_height);
    const DrawingAlignment alignment = align_drawing(drawing_darkness(scan), mask);
    EXPECT_FALSE(alignment.same_frame);
    EXPECT_LE(error_of(alignment.to_view, to_paper, mask), 1);
}

TEST(AlignDrawing, RefusesDrawingsOfSomethingElse) {
    const Image mask = mask_of(cow);
    for (const Shape& other : {Shape(star), Shape(blob)}) {
        const Image scan = scan_of(hatches(other, 0.6f, 7, -500), laid_down(1.2, 0.05, 600, 500), 600, 500);
        try {
            align_drawing(drawing_darkness(scan), mask);
            FAIL() << "a drawing of another object was accepted";
        } catch (const DataError& error) {
            EXPECT_THAT(error.what(), testing::AllOf(testing::HasSubstr("residual"), testing::HasSubstr("draw over")));
        }
    }
}

TEST(AlignDrawing, RefusesWhatCannotBeAligned) {
    const Image mask = mask_of(blob);
    EXPECT_THROW(align_drawing(FloatImage(200, 100, 1), mask), DataError);  // blank
    EXPECT_THROW(align_drawing(FloatImage(1, 1, 1, 1.0f), mask), DataError);
    EXPECT_THROW(align_drawing(ink_drawing(std::vector<InkStroke>{{{{50, 50}, {51, 50}}, 4, 1}}, 100, 100), mask),
                 DataError);  // a dot
    const FloatImage drawing = ink_drawing(hatches(blob, 0.6f, 8, -500), k_scan_width, k_scan_height);
    EXPECT_THROW(align_drawing(drawing, Image(k_scan_width, k_scan_height, 1)), UsageError);  // no object
    EXPECT_THROW(align_drawing(drawing, Image()), UsageError);
    EXPECT_THROW(align_drawing(drawing, Image(k_scan_width, k_scan_height, 3, 255)), UsageError);
    EXPECT_THROW(align_drawing(FloatImage(), mask), UsageError);
    EXPECT_THROW(align_drawing(FloatImage(0, 0, 1), mask), UsageError);
}

TEST(AlignDrawing, DoesNotDependOnTheNumberOfThreads) {
    const Image mask = mask_of(star);
    const Image scan = scan_of(hatches(star, 0.6f, 8, -500), laid_down(1.1, 0.08, 520, 420), 520, 420);
    const auto run = [&](std::size_t threads) {
        const ThreadLimit limit(threads);
        return align_drawing(drawing_darkness(scan), mask);
    };
    const DrawingAlignment one = run(1), all = run(0);
    EXPECT_EQ(one.to_view.scale(), all.to_view.scale());
    EXPECT_EQ(one.to_view.rotation(), all.to_view.rotation());
    EXPECT_EQ(one.residual, all.residual);
}

TEST(Similarity, IsUndoneByItsInverse) {
    const Similarity s(1.7, 0.6, 12, -30);
    const Vec2 at(37, 11);
    EXPECT_LT((s.inverse().apply(s.apply(at)) - at).norm(), 1e-4);
    EXPECT_LT((s.then(Similarity(0.5, -2, 3, 4)).apply(at) - Similarity(0.5, -2, 3, 4).apply(s.apply(at))).norm(),
              1e-4);
    EXPECT_NEAR(s.scale(), 1.7, 1e-12);
    EXPECT_NEAR(s.rotation(), 0.6, 1e-12);
    EXPECT_LT((Similarity(1, k_pi / 2).apply({1, 0}) - Vec2(0, 1)).norm(), 1e-6);  // x turns towards y
}

TEST(WarpDrawing, KeepsInkWhenItShrinks) {
    const FloatImage drawing = ink_drawing(hatches(blob, 0.6f, 9, -500), k_scan_width, k_scan_height);
    const auto ink = [](const FloatImage& image) {
        double sum = 0;
        for (const float value : image.data) sum += static_cast<double>(value);
        return sum;
    };
    EXPECT_EQ(warp_drawing(drawing, {}, k_scan_width, k_scan_height).data, drawing.data);
    for (const double factor : {0.9, 0.5, 0.37, 0.11}) {
        const FloatImage small = warp_drawing(drawing, Similarity(factor, 0.3, 60, 20), k_scan_width, k_scan_height);
        EXPECT_NEAR(ink(small), factor * factor * ink(drawing), 0.01 * factor * factor * ink(drawing)) << factor;
    }
    const FloatImage whole(8, 8, 1, 1.0f);
    const FloatImage moved = warp_drawing(whole, Similarity(1, 0, 4, 0), 16, 8);
    EXPECT_EQ(moved.pixel(3, 4)[0], 0);
    EXPECT_EQ(moved.pixel(5, 4)[0], 1);
    EXPECT_EQ(moved.pixel(13, 4)[0], 0);
}

TEST(WarpDrawing, RefusesImagesWithoutSense) {
    EXPECT_THROW(warp_drawing(FloatImage(4, 4, 3), {}, 4, 4), UsageError);
    EXPECT_THROW(warp_drawing(FloatImage(4, 4, 1), {}, 0, 4), UsageError);
}

}  // namespace
}  // namespace exemplar
