#include <numbers>

#include "host/labeling/features/feature_families.h"
#include "host/shape/log_bins.h"
#include "host/shape/percentile.h"
#include "tests/labeling/features/features_support.h"

namespace exemplar {
namespace {

using namespace feature_tests;

TEST(Percentile, OfWeightedValues) {
    std::vector<std::pair<float, float>> values{{3.0F, 1.0F}, {1.0F, 1.0F}, {2.0F, 8.0F}};
    EXPECT_EQ(weighted_percentile(values, 0.05), 1.0F);
    EXPECT_EQ(weighted_percentile(values, 0.5), 2.0F);
    EXPECT_EQ(weighted_percentile(values, 0.95), 3.0F);
    WeightedHistogram histogram(1.0F, 100);
    for (int i = 0; i < 10000; ++i) histogram.add(static_cast<float>(i) / 10000.0F, 0.1);
    std::array<float, 3> out{};
    histogram.percentiles(std::array{0.1, 0.333, 0.99}, out);
    EXPECT_NEAR(out[0], 0.1F, 1e-3F);
    EXPECT_NEAR(out[1], 0.333F, 1e-3F);
    EXPECT_NEAR(out[2], 0.99F, 1e-3F);
}

TEST(GeodesicFeatures, OfASphereAreEqualEverywhere) {
    const PreparedMesh prepared = prepare_mesh(shapes::icosphere(4, 1.0F), 600);
    const FeatureMatrix features = geodesic_features(prepared);
    // The mean distance on a sphere is pi r / 2; what is left after subtracting the minimum is the graph's unevenness.
    const float mean = 0.5F * std::numbers::pi_v<float> * prepared.mesh.vertices[0].norm();
    for (std::size_t k = 0; k < features.cols(); ++k) {
        EXPECT_EQ(*std::ranges::min_element(features.column(k)), 0.0F);
        EXPECT_LT(*std::ranges::max_element(features.column(k)), (k == 1 ? 0.3F : 0.13F) * mean) << features.names[k];
    }
}

TEST(GeodesicFeatures, OfARodFollowTheFormula) {
    const PreparedMesh prepared = prepare_mesh(shapes::cylinder(0.01F, 2.0F, 6, 200, true), 100000);
    const FeatureMatrix features = geodesic_features(prepared);
    // At x in [-h, h] the mean distance is (x^2 + h^2) / (2 h), which is least, h / 2, at the middle.
    float half = 0.0F;
    for (const Vec3& p : prepared.center) half = std::max(half, std::abs(p.z()));
    // Zigzag paths over the faces are longer than straight ones, by the same factor everywhere.
    const float stretch = *std::ranges::max_element(features.column(0)) / (0.5F * half);
    EXPECT_GT(stretch, 0.99F);
    EXPECT_LT(stretch, 1.35F);
    for (std::size_t f = 0; f < prepared.face_count(); ++f) {
        const float x = prepared.center[f].z();
        EXPECT_NEAR(features.column(0)[f], stretch * x * x / (2.0F * half), 0.02F * half);
    }
}

TEST(GeodesicFeatures, AreOrderedAsPercentilesAre) {
    const PreparedMesh prepared = prepare_mesh(shapes::cylinder(0.1F, 2.0F, 8, 40, true), 1000);
    const FeatureMatrix features = geodesic_features(prepared);
    // The end of a rod is farther from everything than its middle, in every statistic.
    std::size_t end = 0, middle = 0;
    for (std::size_t f = 0; f < prepared.face_count(); ++f) {
        if (prepared.center[f].z() > prepared.center[end].z()) end = f;
        if (std::abs(prepared.center[f].z()) < std::abs(prepared.center[middle].z())) middle = f;
    }
    for (std::size_t k = 0; k < features.cols(); ++k) EXPECT_GE(features.column(k)[end], features.column(k)[middle]);
}

double row_sum(const FeatureMatrix& matrix, const std::string& prefix, std::size_t row) {
    double sum = 0.0;
    for (std::size_t k = 0; k < matrix.cols(); ++k) {
        if (matrix.names[k].starts_with(prefix)) sum += static_cast<double>(matrix.column(k)[row]);
    }
    return sum;
}

TEST(ShapeContextFeatures, SumToTheSurfaceInRange) {
    const TriangleMesh mesh = shapes::icosphere(4, 1.0F);
    for (const std::size_t samples : {500U, 100000U}) {
        FeatureOptions options;
        options.samples = samples;
        const FeatureMatrix unary = compute_features(mesh, options).unary;
        for (std::size_t f = 0; f < mesh.face_count(); f += 101) {
            const double sum = row_sum(unary, "shape_context.5x4.", f);
            EXPECT_NEAR(sum, 0.95, 0.03);  // the range ends at the 95th percentile
            for (const char* other : {"5x6", "5x8", "10x4", "10x6", "10x8"}) {
                EXPECT_NEAR(row_sum(unary, std::string("shape_context.") + other + ".", f), sum, 1e-4);
            }
            EXPECT_NEAR(row_sum(unary, "shape_context.10x4.d4", f) + row_sum(unary, "shape_context.10x4.d5", f),
                        row_sum(unary, "shape_context.5x8.d2", f), 1e-4);
        }
    }
}

TEST(ShapeContextFeatures, OfAPlaneLieAtRightAngles) {
    const FeatureMatrix unary = compute_features(shapes::grid(20, 20, 1.0F)).unary;
    for (std::size_t f = 0; f < unary.rows; f += 17) {
        // The middle sectors share what lies exactly between them.
        for (const char* ring : {"d1", "d2", "d3"}) {
            const std::string name = std::string("shape_context.5x4.") + ring;
            EXPECT_NEAR(column(unary, name + "a1")[f], column(unary, name + "a2")[f], 1e-3F);
            EXPECT_NEAR(column(unary, name + "a0")[f] + column(unary, name + "a3")[f], 0.0F, 1e-6F);
        }
    }
}

TEST(ShapeContextFeatures, OfASphereLieBelowTheFace) {
    const TriangleMesh mesh = shapes::icosphere(4, 1.0F);
    const FeatureMatrix unary = compute_features(mesh).unary;
    // A point at geodesic angle t is seen at 90 + t / 2 degrees from the normal; the last ring (its inner edge at 0.59
    // of 154 degrees) is seen at more than 135 degrees.
    for (std::size_t f = 0; f < mesh.face_count(); f += 101) {
        const double last = row_sum(unary, "shape_context.5x4.d4", f);
        EXPECT_GT(last, 0.3);
        EXPECT_GT(column(unary, "shape_context.5x4.d4a3")[f], 0.9 * last);
        EXPECT_NEAR(column(unary, "shape_context.5x4.d4a0")[f], 0.0F, 1e-6F);
    }
}

TEST(SpinFeatures, OfAPlaneStayInTheMiddleRows) {
    const PreparedMesh prepared = prepare_mesh(shapes::grid(20, 20, 1.0F), 100000);
    const FeatureMatrix features = spin_features(prepared);
    for (std::size_t f = 0; f < features.rows; f += 23) {
        double middle = 0.0, all = 0.0;
        for (std::size_t k = 0; k < features.cols(); ++k) {
            all += static_cast<double>(features.column(k)[f]);
            if (features.names[k].ends_with("b4") || features.names[k].ends_with("b5")) {
                middle += static_cast<double>(features.column(k)[f]);
            }
        }
        EXPECT_NEAR(middle, 1.0, 1e-4);  // the whole plane lies within 3 units, its normals agree
        EXPECT_NEAR(all, middle, 1e-5);
    }
}

TEST(SpinFeatures, OfASphereFollowItsProfile) {
    const PreparedMesh prepared = prepare_mesh(shapes::icosphere(4, 1.0F), 100000);
    const FeatureMatrix features = spin_features(prepared);
    // Only the half with agreeing normals counts, by its cosine: the sum over the sphere is the mean of max(0, cos) =
    // 1/4.
    for (std::size_t f = 0; f < features.rows; f += 101) {
        double sum = 0.0, above = 0.0;
        for (std::size_t k = 0; k < features.cols(); ++k) {
            sum += static_cast<double>(features.column(k)[f]);
            if (features.names[k].back() >= '6') above += static_cast<double>(features.column(k)[f]);
        }
        EXPECT_NEAR(sum, 0.25, 0.005);
        EXPECT_NEAR(above, 0.0, 1e-6);
    }
}

TEST(ContextGeometryOfAMesh, HoldsRangesAndPositions) {
    const TriangleMesh mesh = lopsided_torus(24, 16);
    const PreparedMesh prepared = prepare_mesh(mesh, 100);
    const ContextGeometry context = context_geometry(prepared);
    const std::size_t faces = mesh.face_count();
    ASSERT_EQ(context.faces, faces);
    ASSERT_EQ(context.geodesic_bin.size(), 100 * faces);
    ASSERT_EQ(context.axis_position.size(), k_context_axes * faces);
    const float largest = *std::ranges::max_element(prepared.distance);
    for (std::size_t i = 0; i < context.geodesic_bin.size(); i += 11) {
        const float position = std::log10(1.0F + 9.0F * prepared.distance[i] / largest) * 5.0F;
        EXPECT_NEAR(static_cast<float>(context.geodesic_bin[i]) + 0.5F, position, 0.501F);
    }
    for (std::size_t axis = 0; axis < k_context_axes; ++axis) {
        float widest = 0.0F;
        const std::span<const float> position(context.axis_position.data() + axis * faces, faces);
        for (const std::uint32_t s : context.sample_face) {
            for (const float x : position) widest = std::max(widest, std::abs(x - position[s]));
        }
        for (std::size_t b = 1; b < k_context_bins; ++b) {
            const double expected =
                static_cast<double>(widest) * (std::pow(10.0, static_cast<double>(b) / 5.0) - 1.0) / 9.0;
            EXPECT_NEAR(static_cast<double>(context.axis_edges[axis][b - 1]), expected, 1e-4);
        }
    }
}

// Axis signs are arbitrary, yet the two ends of a rod are far apart along a principal axis: distances there are
// |x_i - x_j|. The sides of a symmetry plane are alike: its positions are distances.
TEST(ContextGeometryOfAMesh, TellsTheEndsOfARodApart) {
    const TriangleMesh rod = shapes::cylinder(0.1F, 4.0F, 8, 60, true);
    const PreparedMesh prepared = prepare_mesh(rod, 200);
    const ContextGeometry context = context_geometry(prepared);
    std::vector<float> at_top(context.faces);  // one class: P = 1 in the top tenth of the rod
    for (std::size_t i = 3 * context.faces; i < context.axis_position.size(); ++i) {
        ASSERT_GE(context.axis_position[i], 0.0F);
    }
    const float top = 0.8F * prepared.mesh.vertices[0].cwiseAbs().maxCoeff();
    std::size_t bottom_face = 0, top_face = 0;
    for (std::size_t f = 0; f < context.faces; ++f) {
        const float z = prepared.center[f].z();
        at_top[f] = z > top ? 1.0F : 0.0F;
        if (z < prepared.center[bottom_face].z()) bottom_face = f;
        if (z > prepared.center[top_face].z()) top_face = f;
    }
    std::vector<float> out(k_context_measures * k_context_bins * context.faces);
    CpuContextHistograms().accumulate(context, at_top, 1, out);
    for (const std::size_t measure : {0U, 1U}) {  // the geodesic distance and the first principal axis
        const auto value = [&](std::size_t bin, std::size_t face) {
            return out[(measure * k_context_bins + bin) * context.faces + face];
        };
        double all = 0.0;
        for (std::size_t b = 0; b < k_context_bins; ++b) all += static_cast<double>(value(b, bottom_face));
        EXPECT_NEAR(all, 0.1, 0.03);
        EXPECT_NEAR(value(k_context_bins - 1, bottom_face), all, 1e-6);
        EXPECT_NEAR(value(k_context_bins - 1, top_face), 0.0, 1e-6);
    }
}

TEST(ContextGeometryOfAMesh, HasNoRangeBetweenParts) {
    const TriangleMesh sphere = shapes::icosphere(1, 1.0F);
    const PreparedMesh prepared = prepare_mesh(shapes::joined(sphere, shapes::translated(sphere, Vec3(5, 0, 0))), 1000);
    const ContextGeometry context = context_geometry(prepared);
    const std::size_t faces = prepared.face_count(), half = faces / 2;
    for (std::size_t s = 0; s < faces; ++s) {
        for (std::size_t f = 0; f < faces; ++f) {
            EXPECT_EQ(context.geodesic_bin[s * faces + f] == k_no_bin, (context.sample_face[s] < half) != (f < half));
        }
    }
}

}  // namespace
}  // namespace exemplar
