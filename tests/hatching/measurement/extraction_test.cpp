#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "host/core/errors.h"
#include "host/core/parallel.h"
#include "host/hatching/drawing/drawing_input.h"
#include "host/hatching/fields/hatching_fields.h"
#include "host/hatching/measurement/stroke_measurements.h"
#include "tests/hatching/measurement/test_drawings.h"

namespace exemplar {
namespace {

using namespace test;

constexpr int k_size = 300;
const Vec2 k_center(150.3f, 149.6f);  // off the pixel grid

Image whole(int width, int height) {
    return Image(width, height, 1, 1);
}

StrokeMeasurements measure(const std::vector<InkStroke>& strokes, const ScanOptions& scan = {},
                           const MeasuringOptions& options = {}, int size = k_size) {
    const Image drawing = scanned(ink_drawing(strokes, size, size), scan);
    return measure_strokes(drawing_darkness(drawing), whole(size, size), options);
}

/// How far properties are from the truth over the stroke pixels that are not at intersections: relative but for the
/// orientation, which is in degrees.
struct Errors {
    std::vector<float> orientation, thickness, intensity, spacing, length;

    void add(const StrokeMeasurements& m, std::size_t i, float angle, const Family& truth) {
        const auto relative = [](float value, float right) { return std::abs(value / right - 1); };
        orientation.push_back(180 / k_pi * orientation_difference(m.orientation[i], angle));
        thickness.push_back(relative(m.thickness[i], truth.width));
        intensity.push_back(relative(m.intensity[i], truth.tone));
        spacing.push_back(relative(m.spacing[i], truth.spacing));
        length.push_back(relative(m.length[i], truth.length));
    }
};

/// The bounds of median errors that every drawing keeps.
void expect_small(const Errors& errors, const std::string& what) {
    SCOPED_TRACE(what);
    ASSERT_GT(errors.orientation.size(), 500u);
    EXPECT_LE(quantile(errors.orientation, 0.5), 2);
    EXPECT_LE(quantile(errors.orientation, 0.95), 5);
    EXPECT_LE(quantile(errors.thickness, 0.5), 0.04f);
    EXPECT_LE(quantile(errors.intensity, 0.5), 0.08f);
    EXPECT_LE(quantile(errors.spacing, 0.5), 0.02f);
    EXPECT_LE(quantile(errors.length, 0.5), 0.03f);
}

/// Each stroke pixel by the family whose direction is nearest to the one measured.
std::vector<Errors> errors_by_family(const StrokeMeasurements& m, const std::vector<Family>& families) {
    std::vector<Errors> errors(families.size());
    for (std::size_t i = 0; i < m.size(); ++i) {
        if (!m.stroke[i] || m.intersection[i]) continue;
        const auto off = [&](const Family& f) { return orientation_difference(m.orientation[i], f.angle); };
        const auto nearest = std::min_element(families.begin(), families.end(),
                                              [&](const Family& a, const Family& b) { return off(a) < off(b); });
        errors[static_cast<std::size_t>(nearest - families.begin())].add(m, i, nearest->angle, *nearest);
    }
    return errors;
}

double level_accuracy(const StrokeMeasurements& m, const std::vector<Family>& families, const Vec2& center) {
    std::size_t right = 0;
    for (int y = 0; y < m.height; ++y)
        for (int x = 0; x < m.width; ++x) {
            const Vec2 at = Vec2(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f) - center;
            const auto level =
                std::count_if(families.begin(), families.end(), [&](const Family& f) { return f.hatches(at); });
            right += m.level[static_cast<std::size_t>(y) * m.width + x] == level;
        }
    return static_cast<double>(right) / static_cast<double>(m.size());
}

struct DrawingCase {
    std::string name;
    std::vector<Family> families;
    ScanOptions scan;
};
void PrintTo(const DrawingCase& drawing, std::ostream* out) {
    *out << drawing.name;
}

class Extraction : public testing::TestWithParam<DrawingCase> {};

TEST_P(Extraction, FindsWhatWasDrawn) {
    const auto& [name, families, scan] = GetParam();
    std::vector<InkStroke> strokes;
    for (const Family& family : families) add_family(family, k_center, strokes);
    const StrokeMeasurements m = measure(strokes, scan);
    for (const Errors& errors : errors_by_family(m, families)) expect_small(errors, name);
    EXPECT_GE(level_accuracy(m, families, k_center), 0.95) << name;
}

std::vector<DrawingCase> straight_drawings() {
    const ScanOptions noisy{0, 0.03f, 0.93f, 0.1f}, blurred{0.7f, 0.02f, 0.9f, 0.08f};
    std::vector<DrawingCase> cases;
    for (const float angle : {0.0f, 0.3f, k_pi / 4, 1.2f, k_pi / 2, 2.5f})
        cases.push_back({fmt::format("angle_{:.0f}", 180 / k_pi * angle), {{angle, 7, 2, 0.8f, 200, 25}}, {}});
    for (const float width : {1.5f, 2.0f, 3.0f, 4.5f, 6.0f})
        for (const float tone : {0.3f, 1.0f}) {
            const float spacing = std::max(7.0f, 2.2f * width);
            const Family family{0.4f, spacing, width, tone, 200, 2 * static_cast<int>(90 / spacing) + 1};
            const std::string name = fmt::format("width_{:.0f}_tone_{:.0f}", 10 * width, 10 * tone);
            cases.push_back({name, {family}, {}});
            cases.push_back({name + "_noisy", {family}, noisy});
            if (width >= 3) cases.push_back({name + "_blurred", {family}, blurred});
        }
    for (const float spacing : {5.0f, 10.0f, 15.0f})
        cases.push_back({fmt::format("spacing_{:.0f}", spacing),
                         {{0.9f, spacing, 1.5f, 0.7f, 190, 2 * static_cast<int>(90 / spacing) + 1}},
                         noisy});
    return cases;
}

std::vector<DrawingCase> crossed_drawings() {
    const ScanOptions scan{0.3f, 0.02f, 0.94f, 0.06f};
    std::vector<DrawingCase> cases;
    for (const float degrees : {90.0f, 60.0f, 45.0f, 30.0f})
        for (const auto& [spacing, width] : {std::pair{7.0f, 1.5f}, std::pair{10.0f, 1.5f}, std::pair{10.0f, 3.0f}}) {
            const Family first{0.2f, spacing, width, 0.9f, 190, 2 * static_cast<int>(85 / spacing) + 1};
            Family second = first;
            second.angle += degrees * k_pi / 180;
            cases.push_back({fmt::format("crossed_{:.0f}_spacing_{:.0f}_width_{:.0f}", degrees, spacing, 10 * width),
                             {first, second},
                             scan});
        }
    const Family dense{0.2f, 5, 2, 0.9f, 190, 35};
    Family across = dense;
    across.angle = 1.6f;
    cases.push_back({"crossed_dense", {dense, across}, scan});
    return cases;
}

const auto k_name_of = [](const auto& drawing) { return drawing.param.name; };
INSTANTIATE_TEST_SUITE_P(Straight, Extraction, testing::ValuesIn(straight_drawings()), k_name_of);
INSTANTIATE_TEST_SUITE_P(Crossed, Extraction, testing::ValuesIn(crossed_drawings()), k_name_of);

InkStroke arc(const Vec2& center, float radius, float from, float to, float width, float tone) {
    InkStroke stroke{{}, width, tone};
    const int steps = static_cast<int>(radius * (to - from)) + 2;
    for (int k = 0; k <= steps; ++k)
        stroke.points.push_back(
            center + radius * direction(from + (to - from) * static_cast<float>(k) / static_cast<float>(steps)));
    return stroke;
}

TEST(CurvedStrokes, AreFollowed) {
    std::vector<InkStroke> strokes;
    for (float radius = 24; radius < 130; radius += 8) strokes.push_back(arc(k_center, radius, 0.2f, 2.9f, 2, 0.9f));
    const StrokeMeasurements m = measure(strokes, {0.4f, 0.02f, 0.95f, 0.05f}, {.smoothing = 0});
    Errors errors;
    for (int y = 0; y < k_size; ++y)
        for (int x = 0; x < k_size; ++x) {
            const std::size_t i = static_cast<std::size_t>(y) * k_size + x;
            if (!m.stroke[i]) continue;
            const Vec2 out = Vec2(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f) - k_center;
            const float radius = 24 + 8 * std::round((out.norm() - 24) / 8);
            errors.add(m, i, std::atan2(out.y(), out.x()) + k_pi / 2, {0, 8, 2, 0.9f, 2.7f * radius, 1});
        }
    expect_small(errors, "arcs");
    EXPECT_TRUE(m.intersections.empty());
    EXPECT_EQ(std::count(m.level.begin(), m.level.end(), k_cross_hatching), 0);
}

TEST(CurvedStrokes, ClosedOnesHaveTheirCircumference) {
    std::vector<InkStroke> strokes;
    for (float radius = 20; radius < 130; radius += 9)
        strokes.push_back(arc(k_center, radius, 0, 2 * k_pi, 2.2f, 0.9f));
    const StrokeMeasurements m = measure(strokes, {}, {.smoothing = 0});
    std::vector<float> errors;
    for (int y = 0; y < k_size; ++y)
        for (int x = 0; x < k_size; ++x) {
            const std::size_t i = static_cast<std::size_t>(y) * k_size + x;
            if (!m.stroke[i]) continue;
            const float out = (Vec2(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f) - k_center).norm();
            errors.push_back(std::abs(m.length[i] / (2 * k_pi * (20 + 9 * std::round((out - 20) / 9))) - 1));
        }
    EXPECT_LE(quantile(errors, 0.9), 0.03f);
    for (std::size_t i = 0; i < m.size(); ++i) EXPECT_NE(m.level[i], k_cross_hatching);
}

TEST(StrokeLength, IsThatOfDashes) {
    for (const float length : {20.0f, 45.0f, 90.0f}) {
        std::vector<InkStroke> strokes;
        const Vec2 along = direction(0.5f), across(-along.y(), along.x());
        for (int row = -12; row <= 12; ++row)
            for (float at = -110 + (row % 2 ? 0.4f * length : 0); at + length < 110; at += length + 8) {
                const Vec2 start = k_center + at * along + 8.0f * static_cast<float>(row) * across;
                strokes.push_back({{start, start + length * along}, 2, 0.9f});
            }
        const StrokeMeasurements m = measure(strokes, {0.3f, 0.02f, 0.95f, 0.05f});
        std::vector<float> errors;
        for (std::size_t i = 0; i < m.size(); ++i)
            if (m.stroke[i]) errors.push_back(std::abs(m.length[i] / length - 1));
        EXPECT_LE(quantile(errors, 0.5), 0.05f) << length;
        const std::set<std::int32_t> ids(m.stroke_id.begin(), m.stroke_id.end());
        EXPECT_EQ(ids.size(), strokes.size() + 1) << "one per dash, and none";
    }
}

TEST(StrokeLength, OfAPenThatTurnsBackIsThatOfItsStrokes) {
    InkStroke pen{{}, 2, 0.9f};  // to and fro without leaving the paper
    for (int k = 0; k < 24; ++k) {
        const float y = -96.0f + 8.0f * static_cast<float>(k), x = k % 2 ? 90.0f : -90.0f;
        pen.points.push_back(k_center + Vec2(x, y));
        pen.points.push_back(k_center + Vec2(-x, y));
    }
    const StrokeMeasurements m = measure({pen});
    std::vector<float> length, spacing;
    for (std::size_t i = 0; i < m.size(); ++i)
        if (m.stroke[i]) length.push_back(m.length[i]), spacing.push_back(m.spacing[i]);
    EXPECT_NEAR(quantile(length, 0.5), 180, 9);
    EXPECT_NEAR(quantile(spacing, 0.5), 8, 0.1);
    EXPECT_EQ(std::count(m.level.begin(), m.level.end(), k_cross_hatching), 0);
}

/// The left half blank, then a band of hatches, then one of cross-hatches.
std::vector<InkStroke> three_regions() {
    std::vector<InkStroke> strokes;
    add_family({0.15f, 8, 2, 0.9f, 170, 25}, {190, 150}, strokes);
    std::vector<InkStroke> across;
    add_family({1.75f, 8, 2, 0.9f, 200, 11}, {232, 143}, across);
    strokes.insert(strokes.end(), across.begin(), across.end());
    return strokes;
}

TEST(HatchingLevel, ChangesWhereHatchesDo) {
    const StrokeMeasurements m = measure(three_regions(), {0.3f, 0.02f, 0.95f, 0.05f});
    const Family hatches{0.15f, 8, 2, 0.9f, 170, 25}, across{1.75f, 8, 2, 0.9f, 200, 11};
    std::size_t right = 0, near_border = 0, borders = 0;
    const auto level_at = [&](const Vec2& at) {
        return static_cast<int>(hatches.hatches(at - Vec2(190, 150))) + across.hatches(at - Vec2(232, 143));
    };
    for (int y = 0; y < k_size; ++y)
        for (int x = 0; x < k_size; ++x) {
            const std::size_t i = static_cast<std::size_t>(y) * k_size + x;
            const Vec2 at(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
            right += m.level[i] == level_at(at);
            if (!m.boundary[i] || m.stroke[i]) continue;
            ++borders;
            const int around = level_at(at);
            bool near = false;
            for (int k = 0; k < 16; ++k)
                near |= level_at(at + 5.0f * direction(static_cast<float>(k) * k_pi / 8)) != around;
            near_border += near;
        }
    EXPECT_GE(static_cast<double>(right) / static_cast<double>(m.size()), 0.95);
    EXPECT_GT(borders, 500u);
    EXPECT_GE(static_cast<double>(near_border), 0.9 * static_cast<double>(borders));
}

TEST(HatchingLevel, OfTwoByTwoStrokesIsSingleAndOfThreeByThreeIsCrossed) {
    for (const int count : {2, 3}) {
        std::vector<InkStroke> strokes;
        add_family({0, 10, 2, 1, 60, count}, k_center, strokes);
        add_family({k_pi / 2, 10, 2, 1, 60, count}, k_center, strokes);
        const StrokeMeasurements m = measure(strokes);
        EXPECT_EQ(m.intersections.size(), static_cast<std::size_t>(count) * count);
        EXPECT_EQ(std::count(m.level.begin(), m.level.end(), k_cross_hatching) > 0, count == 3);
    }
}

TEST(HatchingLevel, IsSingleWhereStrokesOfTwoDirectionsDoNotCross) {
    // Strokes rise and fall in turn, beside some that do cross.
    std::vector<InkStroke> strokes;
    for (int row = 0; row < 20; ++row) {
        const Vec2 middle(90, 20 + 13 * static_cast<float>(row)), half = 20 * direction(row % 2 ? 0.3f : k_pi - 0.3f);
        strokes.push_back({{middle - half, middle + half}, 2, 1});
    }
    add_family({0, 10, 2, 1, 90, 8}, {155, 150}, strokes);
    add_family({k_pi / 2, 10, 2, 1, 90, 8}, {155, 150}, strokes);
    const StrokeMeasurements m = measure(strokes);
    EXPECT_GT(std::count(m.level.begin(), m.level.end(), k_cross_hatching), 60 * 60);
    for (int y = 0; y < k_size; ++y)
        for (int x = 0; x < 85; ++x) EXPECT_NE(m.level[static_cast<std::size_t>(y) * k_size + x], k_cross_hatching);
}

TEST(HatchingLevel, OfALineAloneIsNone) {
    std::vector<InkStroke> strokes;
    add_family({0.3f, 7, 2, 1, 100, 13}, {100, 150}, strokes);
    strokes.push_back({{{250, 20}, {255, 150}, {245, 280}}, 3, 1});
    const StrokeMeasurements m = measure(strokes);
    for (int y = 0; y < k_size; ++y)
        for (int x = 200; x < k_size; ++x) {
            const std::size_t i = static_cast<std::size_t>(y) * k_size + x;
            EXPECT_EQ(m.level[i], k_no_hatching);
            EXPECT_EQ(m.spacing[i], 0);
        }
}

TEST(StrokeMeasurements, ScaleWithTheDrawing) {
    std::vector<InkStroke> once = three_regions(), twice = once;
    for (InkStroke& stroke : twice) {
        stroke.width *= 2;
        for (Vec2& point : stroke.points) point *= 2;
    }
    const StrokeMeasurements small = measure(once), large = measure(twice, {}, {}, 2 * k_size);
    const auto median = [](const StrokeMeasurements& m, const std::vector<float>& values) {
        std::vector<float> known;
        for (std::size_t i = 0; i < m.size(); ++i)
            if (m.stroke[i] && !m.intersection[i]) known.push_back(values[i]);
        return quantile(known, 0.5);
    };
    EXPECT_NEAR(median(large, large.thickness), 2 * median(small, small.thickness), 0.1);
    EXPECT_NEAR(median(large, large.spacing), 2 * median(small, small.spacing), 0.3);
    EXPECT_NEAR(median(large, large.length), 2 * median(small, small.length), 20);
    EXPECT_NEAR(median(large, large.intensity), median(small, small.intensity), 0.03);
    std::size_t same = 0;
    for (int y = 0; y < k_size; ++y)
        for (int x = 0; x < k_size; ++x)
            same += small.level[static_cast<std::size_t>(y) * k_size + x] ==
                    large.level[static_cast<std::size_t>(2 * y + 1) * 2 * k_size + 2 * x + 1];
    EXPECT_GE(static_cast<double>(same), 0.97 * static_cast<double>(small.size()));
}

TEST(StrokeMeasurements, KeepTheInkOfStrokesTooNarrowToTellApart) {
    // A pixel wide and half as dark, or half a pixel and black: the drawings look alike, and so do the measurements.
    for (const auto& [width, tone] : {std::pair{0.5f, 1.0f}, std::pair{1.0f, 0.5f}, std::pair{0.8f, 0.6f}}) {
        std::vector<InkStroke> strokes;
        add_family({0.35f, 8, width, tone, 200, 23}, k_center, strokes);
        const StrokeMeasurements m = measure(strokes);
        std::vector<float> ink;
        for (std::size_t i = 0; i < m.size(); ++i)
            if (m.stroke[i]) {
                ink.push_back(m.thickness[i] * m.intensity[i]);
                EXPECT_GE(m.thickness[i], 1);
            }
        EXPECT_NEAR(quantile(ink, 0.5), width * tone, 0.06f * width * tone);
    }
}

TEST(StrokeMeasurements, OfShakyStrokesAreThoseOfStraightOnes) {
    std::vector<InkStroke> strokes;
    Random random(4);
    const Vec2 along = direction(0.6f), across(-along.y(), along.x());
    for (int k = -11; k <= 11; ++k) {
        InkStroke stroke{{}, 2, 0.8f};
        const auto phase = static_cast<float>(random.uniform(0, 6)), wave = static_cast<float>(random.uniform(30, 60));
        const auto shift = static_cast<float>(random.uniform(-0.8, 0.8));
        for (float t = -90; t <= 90; t += 2) {
            const float off = 9.0f * static_cast<float>(k) + shift + 0.6f * std::sin(2 * k_pi * t / wave + phase);
            stroke.points.push_back(k_center + t * along + off * across);
        }
        strokes.push_back(stroke);
    }
    const StrokeMeasurements m = measure(strokes, {0.4f, 0.03f, 0.92f, 0.08f});
    expect_small(errors_by_family(m, {{0.6f, 9, 2, 0.8f, 180, 23}})[0], "shaky");
}

TEST(StrokeMeasurements, FaintHatchesBesideDarkOnesAreFollowed) {
    std::vector<InkStroke> strokes;
    const Family dark{0.2f, 10, 4, 1, 180, 17}, faint{1.6f, 10, 2, 0.4f, 180, 17};
    add_family(dark, k_center, strokes);
    add_family(faint, k_center, strokes);
    const StrokeMeasurements m = measure(strokes, {0, 0.02f, 0.95f, 0.05f}, {.smoothing = 0});
    const std::vector<Errors> errors = errors_by_family(m, {dark, faint});
    expect_small(errors[0], "dark");
    expect_small(errors[1], "faint");
}

TEST(StrokeMeasurements, IgnoreWhatIsOutsideOfTheObject) {
    std::vector<InkStroke> strokes;
    add_family({0.4f, 8, 2, 1, 200, 23}, k_center, strokes);
    const FloatImage darkness = ink_drawing(strokes, k_size, k_size);
    Image left(k_size, k_size, 1);
    for (int y = 0; y < k_size; ++y)
        for (int x = 0; x < k_size / 2; ++x) left.pixel(x, y)[0] = 255;
    const StrokeMeasurements m = measure_strokes(darkness, left);
    std::vector<float> thickness;
    for (std::size_t i = 0; i < m.size(); ++i) {
        if (!left.data[i]) {
            EXPECT_EQ(m.stroke[i] + m.level[i] + m.boundary[i] + m.skeleton[i] + m.intersection[i], 0);
        } else if (m.stroke[i]) {
            thickness.push_back(m.thickness[i]);
        }
    }
    EXPECT_NEAR(quantile(thickness, 0.5), 2, 0.1);
    EXPECT_NEAR(quantile(thickness, 0.99), 2, 0.4) << "strokes cut by the mask keep their width";
}

TEST(StrokeMeasurements, DoNotDependOnTheNumberOfThreads) {
    const Image drawing = scanned(ink_drawing(three_regions(), k_size, k_size), {0.3f, 0.03f, 0.95f, 0.05f});
    const auto run = [&](std::size_t threads) {
        const ThreadLimit limit(threads);
        return measure_strokes(drawing_darkness(drawing), whole(k_size, k_size));
    };
    const StrokeMeasurements one = run(1), all = run(0);
    EXPECT_EQ(one.stroke, all.stroke);
    EXPECT_EQ(one.skeleton, all.skeleton);
    EXPECT_EQ(one.stroke_id, all.stroke_id);
    EXPECT_EQ(one.intensity, all.intensity);
    EXPECT_EQ(one.thickness, all.thickness);
    EXPECT_EQ(one.orientation, all.orientation);
    EXPECT_EQ(one.spacing, all.spacing);
    EXPECT_EQ(one.length, all.length);
    EXPECT_EQ(one.level, all.level);
    EXPECT_EQ(one.boundary, all.boundary);
}

TEST(StrokeMeasurements, AreInTheirRanges) {
    for (const std::uint64_t seed : {1u, 2u, 3u}) {
        Random random(seed);
        FloatImage darkness(97, 61, 1);
        for (float& value : darkness.data) value = static_cast<float>(random.uniform(-0.1, 1));
        const StrokeMeasurements m = measure_strokes(darkness, whole(97, 61));
        for (std::size_t i = 0; i < m.size(); ++i) {
            ASSERT_LE(m.level[i], k_cross_hatching);
            ASSERT_EQ(m.stroke_id[i] >= 0, m.stroke[i] == 1);
            if (!m.stroke[i]) continue;
            ASSERT_GE(m.thickness[i], 1);
            ASSERT_GT(m.intensity[i], 0);
            ASSERT_LE(m.intensity[i], 1);
            ASSERT_GE(m.orientation[i], 0);
            ASSERT_LT(m.orientation[i], k_pi);
            ASSERT_GE(m.spacing[i], 0);
            ASSERT_GE(m.length[i], 1);
        }
    }
}

TEST(StrokeMeasurements, OfDrawingsWithoutStrokesAreZero) {
    const auto nothing = [](const FloatImage& darkness, const Image& mask) {
        SCOPED_TRACE(fmt::format("{} x {}", darkness.width, darkness.height));
        const StrokeMeasurements m = measure_strokes(darkness, mask);
        EXPECT_EQ(std::count(m.stroke.begin(), m.stroke.end(), 1), 0);
        EXPECT_EQ(std::count(m.level.begin(), m.level.end(), 0), static_cast<std::ptrdiff_t>(m.size()));
        EXPECT_EQ(m.median_spacing, 0);
    };
    nothing(FloatImage(40, 30, 1), whole(40, 30));
    nothing(FloatImage(1, 1, 1), whole(1, 1));
    nothing(FloatImage(1, 1, 1, 1.0f), whole(1, 1));
    nothing(FloatImage(40, 30, 1, 1.0f), whole(40, 30));  // black all over
    nothing(FloatImage(0, 0, 1), whole(0, 0));
    nothing(ink_drawing(std::vector<InkStroke>{{{{20, 15}, {20.5f, 15}}, 4, 1}}, 40, 30), whole(40, 30));  // a dot
    std::vector<InkStroke> strokes;
    add_family({0.4f, 8, 2, 1, 60, 7}, {50, 50}, strokes);
    nothing(ink_drawing(strokes, 100, 100), Image(100, 100, 1));  // nothing of the object
}

/// Nothing is left to explain: by which edge a profile is softened cannot be told.
TEST(StrokeMeasurements, OfRuledLinesWithHardEdgesAreExact) {
    for (const int width : {1, 3}) {
        SCOPED_TRACE(width);
        FloatImage darkness(120, 100, 1);
        for (int y = 10; y < 90; ++y)
            for (int x = 10; x < 110; ++x)
                if (y % 8 < width) darkness.pixel(x, y)[0] = 1;
        const StrokeMeasurements m = measure_strokes(darkness, whole(120, 100));
        std::vector<float> thickness;
        for (std::size_t i = 0; i < m.size(); ++i)
            if (m.stroke[i]) thickness.push_back(m.thickness[i]);
        ASSERT_GT(thickness.size(), 500u);
        EXPECT_NEAR(quantile(thickness, 0.5), width, 0.1);
        EXPECT_NEAR(m.median_spacing, 8, 0.1);
    }
}

TEST(StrokeMeasurements, OneStrokeHasALengthAndNoSpacing) {
    const StrokeMeasurements m = measure({{{{40, 50}, {200, 120}}, 3, 0.7f}});
    std::vector<float> length;
    for (std::size_t i = 0; i < m.size(); ++i)
        if (m.stroke[i]) {
            length.push_back(m.length[i]);
            EXPECT_EQ(m.spacing[i], 0);
        }
    EXPECT_NEAR(quantile(length, 0.5), std::hypot(160, 70), 2);
    EXPECT_EQ(std::count(m.level.begin(), m.level.end(), 0), static_cast<std::ptrdiff_t>(m.size()));
}

TEST(StrokeMeasurements, RefuseImagesThatDoNotGoTogether) {
    EXPECT_THROW(measure_strokes(FloatImage(40, 30, 1), whole(30, 40)), UsageError);
    EXPECT_THROW(measure_strokes(FloatImage(40, 30, 3), whole(40, 30)), UsageError);
    EXPECT_THROW(measure_strokes(FloatImage(40, 30, 1), Image(40, 30, 3)), UsageError);
}

}  // namespace
}  // namespace exemplar
