#include "host/labeling/evaluation/segmentation_metrics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <functional>

#include "host/core/errors.h"
#include "host/core/random.h"
#include "host/labeling/evaluation/evaluation.h"
#include "host/mesh/io/io.h"
#include "tests/support/shapes.h"

namespace exemplar {
namespace {

using Segments = std::vector<std::int32_t>;

/// Flat quadrilaterals of height 1, cut into two triangles each, whose columns begin and end at the coordinates `x`.
TriangleMesh strip(const std::vector<float>& x, std::uint32_t rows) {
    TriangleMesh mesh;
    const auto columns = static_cast<std::uint32_t>(x.size());
    for (std::uint32_t j = 0; j <= rows; ++j)
        for (const float at : x) mesh.vertices.emplace_back(at, static_cast<float>(j), 0.0F);
    for (std::uint32_t j = 0; j < rows; ++j)
        for (std::uint32_t i = 0; i + 1 < columns; ++i) {
            const std::uint32_t a = j * columns + i, b = a + 1, c = b + columns, d = a + columns;
            mesh.faces.push_back({a, b, c});
            mesh.faces.push_back({a, c, d});
        }
    mesh.source_face_count = static_cast<std::uint32_t>(mesh.face_count());
    return mesh;
}

std::vector<float> unit_columns(int count) {
    std::vector<float> x;
    for (int i = 0; i <= count; ++i) x.push_back(static_cast<float>(i));
    return x;
}

/// The number of `cuts` (in rising order) left of each face's center.
Segments cut_at(const TriangleMesh& mesh, const std::vector<float>& cuts, int axis = 0) {
    Segments segments;
    for (const Vec3& center : face_centers(mesh)) {
        std::int32_t segment = 0;
        for (const float cut : cuts) segment += center[axis] > cut ? 1 : 0;
        segments.push_back(segment);
    }
    return segments;
}

/// Mean distance of the triangles' centers from the middle of a strip of unit squares.
double strip_radius(int columns, int rows) {
    double sum = 0;
    for (int i = 0; i < columns; ++i)
        for (int j = 0; j < rows; ++j)
            for (const double third : {1.0 / 3, 2.0 / 3})
                sum += std::hypot(i + third - columns / 2.0, j + (1 - third) - rows / 2.0);
    return sum / (2 * columns * rows);
}

void expect_all_zero(const SegmentationErrors& errors) {
    EXPECT_EQ(errors.rand_index, 0);
    EXPECT_EQ(errors.cut_discrepancy, 0);
    EXPECT_EQ(errors.missing_rate, 0);
    EXPECT_EQ(errors.false_alarm_rate, 0);
    EXPECT_EQ(errors.hamming_distance, 0);
    EXPECT_EQ(errors.global_consistency, 0);
    EXPECT_EQ(errors.local_consistency, 0);
}

Segments random_segments(std::size_t faces, std::size_t segments, Random& random) {
    Segments result;
    for (std::size_t f = 0; f < faces; ++f)
        result.push_back(static_cast<std::int32_t>(random.index(segments)) * 1000 - 7);  // numbers are arbitrary
    return result;
}

TEST(SegmentationMetrics, AShiftedCutHasTheValuesWorkedOutByHand) {
    const TriangleMesh mesh = strip(unit_columns(10), 4);
    const SegmentationErrors errors = SegmentationMetrics(mesh).compare(cut_at(mesh, {4}), cut_at(mesh, {6}));
    // Areas that both hold: 16 left, 8 between the cuts, 16 right; segments of 16 + 24 against 24 + 16.
    EXPECT_NEAR(errors.missing_rate, 8.0 / 40, 1e-12);
    EXPECT_NEAR(errors.false_alarm_rate, 8.0 / 40, 1e-12);
    EXPECT_NEAR(errors.hamming_distance, 0.2, 1e-12);
    EXPECT_NEAR(errors.global_consistency, (8 * (1 - 8.0 / 24) + 16 * (1 - 16.0 / 24)) / 40, 1e-12);
    EXPECT_NEAR(errors.local_consistency, 8 * (1 - 8.0 / 24) / 40, 1e-12);
    // Pairs of the 16 triangles between the cuts and the 32 on either side that only one segmentation joins.
    EXPECT_NEAR(errors.rand_index, 2.0 * 16 * 32 / (80 * 79 / 2.0), 1e-12);
    EXPECT_NEAR(errors.cut_discrepancy, (2 + 2) / strip_radius(10, 4), 1e-5);
}

TEST(SegmentationMetrics, ARefinementIsConsistentButMissesSegments) {
    const TriangleMesh mesh = strip(unit_columns(8), 3);
    const Segments fine = cut_at(mesh, {2, 4, 6}), coarse = cut_at(mesh, {4});
    const SegmentationMetrics metrics(mesh);
    const SegmentationErrors errors = metrics.compare(fine, coarse);
    EXPECT_EQ(errors.global_consistency, 0);
    EXPECT_EQ(errors.local_consistency, 0);
    EXPECT_NEAR(errors.missing_rate, 0.5, 1e-12);
    EXPECT_EQ(errors.false_alarm_rate, 0);
    EXPECT_NEAR(errors.cut_discrepancy, (2 + 0 + 2) / 3.0 / strip_radius(8, 3), 1e-5) << "one way only";
    const SegmentationErrors other = metrics.compare(coarse, fine);
    EXPECT_EQ(other.global_consistency, 0);
    EXPECT_EQ(other.missing_rate, 0);
    EXPECT_NEAR(other.false_alarm_rate, 0.5, 1e-12);
}

TEST(SegmentationMetrics, LocalConsistencyForgivesRefinementOfEitherSideInPlaces) {
    const TriangleMesh mesh = strip(unit_columns(8), 1);
    const SegmentationErrors errors = SegmentationMetrics(mesh).compare(cut_at(mesh, {2, 4}), cut_at(mesh, {4, 6}));
    EXPECT_EQ(errors.local_consistency, 0);
    EXPECT_NEAR(errors.global_consistency, 0.25, 1e-12);  // half the surface is refined, by halves
}

TEST(SegmentationMetrics, AreasNotFacesAreCompared) {
    const TriangleMesh mesh = strip({0, 1, 4}, 1);
    const SegmentationErrors errors = SegmentationMetrics(mesh).compare(cut_at(mesh, {1}), cut_at(mesh, {9}));
    EXPECT_NEAR(errors.missing_rate, 0.25, 1e-7) << "the square of area 1 beside that of area 3";
    EXPECT_NEAR(errors.rand_index, 4.0 / 6, 1e-12) << "pairs of faces";
}

TEST(SegmentationMetrics, EqualSegmentationsHaveNoErrorWhateverTheirNumbers) {
    const TriangleMesh mesh = shapes::icosphere(2, 3);
    Random random(3);
    const Segments segments = random_segments(mesh.face_count(), 5, random);
    Segments renamed = segments;
    for (std::int32_t& segment : renamed) segment = 900000 - segment;
    expect_all_zero(SegmentationMetrics(mesh).compare(segments, renamed));
}

TEST(SegmentationMetrics, CutsAreAnArcApartOnASphere) {
    const TriangleMesh mesh = shapes::icosphere(5, 2);
    const SegmentationErrors errors = SegmentationMetrics(mesh).compare(cut_at(mesh, {-1}, 2), cut_at(mesh, {1}, 2));
    EXPECT_NEAR(errors.cut_discrepancy, 2 * std::acos(0.5), 0.03 * 2 * std::acos(0.5));
}

TEST(SegmentationMetrics, CutDiscrepancyDoesNotDependOnScaleOrDirection) {
    TriangleMesh mesh = shapes::icosphere(3, 1);
    const Segments a = cut_at(mesh, {-0.3F, 0.2F}), b = cut_at(mesh, {0.1F}, 1);
    const double expected = SegmentationMetrics(mesh).compare(a, b).cut_discrepancy;
    EXPECT_GT(expected, 0.1);
    EXPECT_DOUBLE_EQ(SegmentationMetrics(mesh).compare(b, a).cut_discrepancy, expected);
    for (const float scale : {1e-6F, 1e12F}) {  // to a millionth, then to a million
        for (Vec3& vertex : mesh.vertices) vertex *= scale;
        EXPECT_NEAR(SegmentationMetrics(mesh).compare(a, b).cut_discrepancy, expected, 1e-4);
    }
}

TEST(SegmentationMetrics, OneSegmentHasNoCutsToCompare) {
    const TriangleMesh mesh = strip(unit_columns(4), 1);
    const Segments whole = cut_at(mesh, {}), halves = cut_at(mesh, {2});
    const SegmentationMetrics metrics(mesh);
    expect_all_zero(metrics.compare(whole, whole));
    EXPECT_TRUE(std::isnan(metrics.compare(whole, halves).cut_discrepancy));
    EXPECT_TRUE(std::isnan(metrics.compare(halves, whole).cut_discrepancy));
    EXPECT_NEAR(metrics.compare(whole, halves).false_alarm_rate, 0.5, 1e-12);
    // The mean is over those references that have cuts.
    EXPECT_EQ(metrics.mean_errors(halves, std::vector<Segments>{whole, halves}).cut_discrepancy, 0);
    EXPECT_NEAR(metrics.mean_errors(halves, std::vector<Segments>{whole, halves}).missing_rate, 0.25, 1e-12);
    EXPECT_TRUE(std::isnan(metrics.mean_errors(halves, {}).hamming_distance));
}

TEST(SegmentationMetrics, CutsOnAnotherComponentAreARadiusAway) {
    const TriangleMesh half = strip(unit_columns(4), 1);
    const TriangleMesh mesh = shapes::joined(half, shapes::translated(half, Vec3(10, 0, 0)));
    const SegmentationErrors errors = SegmentationMetrics(mesh).compare(cut_at(mesh, {2}), cut_at(mesh, {12}));
    EXPECT_NEAR(errors.cut_discrepancy, 2, 1e-6);
}

TEST(SegmentationMetrics, DegenerateMeshesGiveNoInfinities) {
    TriangleMesh point;
    point.vertices.assign(4, Vec3(1, 1, 1));
    point.faces = {{0, 1, 2}, {0, 2, 3}};
    const SegmentationErrors errors = SegmentationMetrics(point).compare(Segments{0, 1}, Segments{0, 0});
    EXPECT_TRUE(std::isnan(errors.cut_discrepancy));
    EXPECT_NEAR(errors.missing_rate, 0.5, 1e-12) << "faces count equally where none has an area";
    TriangleMesh fin = strip(unit_columns(2), 1);
    fin.faces.push_back({1, 4, 0});
    fin.faces.push_back({0, 0, 1});
    EXPECT_TRUE(std::isfinite(SegmentationMetrics(fin).compare(cut_at(fin, {1}), cut_at(fin, {0.5F})).cut_discrepancy));
}

TEST(SegmentationMetrics, RefuseOtherSizes) {
    const TriangleMesh mesh = strip(unit_columns(2), 1);
    const SegmentationMetrics metrics(mesh);
    EXPECT_THROW(metrics.compare(Segments{0, 1}, Segments(4, 0)), UsageError);
    EXPECT_THROW(metrics.compare(Segments(4, 0), Segments(5, 0)), UsageError);
    EXPECT_THROW(segment_overlap(Segments(4, 0), Segments(5, 0)), UsageError);
    EXPECT_THROW(segment_overlap(Segments(4, 0), Segments(4, 0), std::vector<float>(3)), UsageError);
}

/// Sums over faces i and j as the definitions are written, without a table.
struct ByDefinition {
    const Segments &a, &b;
    const std::vector<float>& areas;

    double area(const std::function<bool(std::size_t)>& holds) const {
        double sum = 0;
        for (std::size_t f = 0; f < areas.size(); ++f) sum += holds(f) ? static_cast<double>(areas[f]) : 0;
        return sum;
    }
    double error(const Segments& s, const Segments& t, std::size_t face) const {
        const double own = area([&](std::size_t f) { return s[f] == s[face]; });
        return area([&](std::size_t f) { return s[f] == s[face] && t[f] != t[face]; }) / own;
    }
    double lost(const Segments& s, const Segments& t) const {  // of t's segments, beyond their best matches in s
        double sum = 0;
        for (std::size_t f = 0; f < areas.size(); ++f) {
            double best = 0;
            std::int32_t match = 0;
            for (const std::int32_t candidate : s) {
                const double shared = area([&](std::size_t g) { return t[g] == t[f] && s[g] == candidate; });
                if (shared > best) best = shared, match = candidate;
            }
            if (s[f] != match) sum += static_cast<double>(areas[f]);
        }
        return sum / area([](std::size_t) { return true; });
    }
};

TEST(SegmentationMetrics, TheTableGivesWhatTheDefinitionsSay) {
    Random random(1);
    for (int trial = 0; trial < 10; ++trial) {
        const std::size_t count = 2 + random.index(30);
        const Segments a = random_segments(count, 4, random), b = random_segments(count, 5, random);
        std::vector<float> areas;
        for (std::size_t f = 0; f < count; ++f) areas.push_back(0.1F + static_cast<float>(random.uniform()));
        const ByDefinition slow{a, b, areas};
        double pairs = 0, forward = 0, backward = 0, local = 0, total = 0;
        for (std::size_t i = 0; i < count; ++i) {
            for (std::size_t j = 0; j < i; ++j) pairs += (a[i] == a[j]) != (b[i] == b[j]) ? 1 : 0;
            const double e_ab = slow.error(a, b, i), e_ba = slow.error(b, a, i), area = static_cast<double>(areas[i]);
            forward += area * e_ab, backward += area * e_ba, local += area * std::min(e_ab, e_ba), total += area;
        }
        const SegmentOverlap overlap = segment_overlap(a, b, areas), reverse = segment_overlap(b, a, areas);
        EXPECT_NEAR(rand_index_error(overlap), pairs * 2 / static_cast<double>(count * (count - 1)), 1e-12);
        EXPECT_NEAR(hamming_distance(overlap).missing_rate, slow.lost(a, b), 1e-9);
        EXPECT_NEAR(hamming_distance(overlap).false_alarm_rate, slow.lost(b, a), 1e-9);
        EXPECT_NEAR(consistency_errors(overlap).global, std::min(forward, backward) / total, 1e-9);
        EXPECT_NEAR(consistency_errors(overlap).local, local / total, 1e-9);
        EXPECT_NEAR(consistency_errors(reverse).global, consistency_errors(overlap).global, 1e-12) << "symmetric";
        EXPECT_NEAR(consistency_errors(reverse).local, consistency_errors(overlap).local, 1e-12);
        EXPECT_NEAR(hamming_distance(reverse).mean(), hamming_distance(overlap).mean(), 1e-12);
        EXPECT_DOUBLE_EQ(rand_index_error(reverse), rand_index_error(overlap));
    }
    EXPECT_EQ(rand_index_error(segment_overlap(Segments{3}, Segments{4})), 0);
}

/// People agree with each other about as well as Chen et al. report.
TEST(SegmentationMetrics, PeopleAgreeOnRealMeshes) {
    const char* data = std::getenv("EXEMPLAR_DATA");
    if (data == nullptr || *data == 0)
        GTEST_SKIP() << "set EXEMPLAR_DATA to the folder that holds labeled/ and seg/ (docs/testing.md)";
    const std::filesystem::path folder = data;
    for (const auto& [path, name] : {std::pair{"labeled/Ant/81.off", "81"}, {"labeled/Human/3.off", "3"}}) {
        const TriangleMesh mesh = read_mesh(folder / path).mesh;
        const std::vector<Segments> people = read_human_segmentations(folder / "seg", name, mesh.face_count());
        ASSERT_GE(people.size(), 5U) << path;
        const SegmentationMetrics metrics(mesh);
        expect_all_zero(metrics.compare(people[1], people[1]));
        SegmentationErrors mean = metrics.mean_errors(people[0], std::span(people).subspan(1));
        EXPECT_GT(mean.rand_index, 0.001) << path;
        EXPECT_LT(mean.rand_index, 0.3) << path;
        EXPECT_GT(mean.hamming_distance, 0.005) << path;
        EXPECT_LT(mean.hamming_distance, 0.35) << path;
        EXPECT_GT(mean.cut_discrepancy, 0.01) << path;
        EXPECT_LT(mean.cut_discrepancy, 0.8) << path;
        EXPECT_LT(mean.global_consistency, 0.3) << path;
        EXPECT_LE(mean.local_consistency, mean.global_consistency) << path;
    }
}

}  // namespace
}  // namespace exemplar
