#include "host/mesh/curvature_estimator.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "host/core/errors.h"
#include "host/core/parallel.h"
#include "host/core/random.h"
#include "tests/support/shapes.h"

namespace exemplar {
namespace {

CurvatureOptions smoothed(double width, double unit = 0) {
    CurvatureOptions options;
    options.smoothing = width;
    options.smoothing_unit = unit;
    return options;
}
VertexCurvature estimated(const TriangleMesh& mesh, const CurvatureOptions& options) {
    return CurvatureEstimator(mesh.faces, mesh.vertex_count()).estimate(mesh.vertices, options);
}
/// A mesh without symmetry, of uneven triangles.
TriangleMesh lumpy() {
    return shapes::transformed(shapes::icosphere(4, 1), [](const Vec3& p) -> Vec3 {
        return p * (1 + 0.2f * std::sin(3 * p.x() + 1) + 0.15f * p.y() * std::cos(4 * p.z()));
    });
}
void expect_equal_bits(const VertexCurvature& a, const VertexCurvature& b) {
    EXPECT_EQ(a.k1, b.k1);
    EXPECT_EQ(a.k2, b.k2);
    EXPECT_EQ(a.e1, b.e1);
    EXPECT_EQ(a.e2, b.e2);
    EXPECT_EQ(a.derivative, b.derivative);
}
void expect_finite(const VertexCurvature& c) {
    for (std::size_t i = 0; i < c.k1.size(); ++i) {
        EXPECT_TRUE(std::isfinite(c.k1[i]) && std::isfinite(c.k2[i]) && c.e1[i].allFinite() && c.e2[i].allFinite())
            << i;
        for (float d : c.derivative[i]) EXPECT_TRUE(std::isfinite(d)) << i;
    }
}
const CurvatureOptions k_kinds[] = {{}, {true, 1.5}, {false, 1}};

TEST(CurvatureEstimator, GivesWhatTheOneOffFunctionGives) {
    const TriangleMesh mesh = lumpy();
    CurvatureEstimator estimator(mesh.faces, mesh.vertex_count());
    expect_equal_bits(estimator.estimate(mesh.vertices), estimate_curvature(mesh, true));
    CurvatureOptions no_derivatives;
    no_derivatives.derivatives = false;
    expect_equal_bits(estimator.estimate(mesh.vertices, no_derivatives), estimate_curvature(mesh, false));
}

TEST(CurvatureEstimator, HasTheNormalsOfTheMesh) {
    TriangleMesh mesh = lumpy();
    mesh.vertices.push_back({5, 5, 5});
    mesh.faces.push_back({1, 1, 2});
    CurvatureEstimator estimator(mesh.faces, mesh.vertex_count());
    estimator.estimate(mesh.vertices);
    const std::vector<Vec3> normals = vertex_normals(mesh);
    for (std::size_t i = 0; i < normals.size(); ++i) EXPECT_LT((estimator.normals()[i] - normals[i]).norm(), 1e-6) << i;
}

TEST(CurvatureEstimator, RemembersNothingOfEarlierPoses) {
    const TriangleMesh mesh = lumpy(), other = shapes::scaled(shapes::rotated(lumpy(), shapes::random_rotation(3)), 2);
    for (const CurvatureOptions& options : k_kinds) {
        CurvatureEstimator estimator(mesh.faces, mesh.vertex_count());
        const VertexCurvature first = estimator.estimate(mesh.vertices, options);
        for (const CurvatureOptions& between : k_kinds) estimator.estimate(other.vertices, between);
        expect_equal_bits(estimator.estimate(mesh.vertices, options), first);
    }
}

TEST(CurvatureEstimator, DoesNotDependOnThreads) {
    const TriangleMesh mesh = shapes::torus(3, 1, 150, 60);
    for (const CurvatureOptions& options : k_kinds) {
        const VertexCurvature many = estimated(mesh, options);
        const ThreadLimit limit(1);
        expect_equal_bits(many, estimated(mesh, options));
    }
}

TEST(CurvatureEstimator, RefusesWhatDoesNotFit) {
    const TriangleMesh mesh = lumpy();
    EXPECT_THROW(CurvatureEstimator(mesh.faces, mesh.vertex_count() - 1), MeshError);
    CurvatureEstimator estimator(mesh.faces, mesh.vertex_count());
    EXPECT_THROW(estimator.estimate(std::span(mesh.vertices).first(10)), UsageError);
    EXPECT_THROW(estimator.estimate(mesh.vertices, smoothed(-1)), UsageError);
    EXPECT_THROW(estimator.estimate(mesh.vertices, smoothed(std::nan(""))), UsageError);
    EXPECT_THROW(estimator.estimate(mesh.vertices, smoothed(1, HUGE_VAL)), UsageError);
    EXPECT_TRUE(CurvatureEstimator({}, 0).estimate({}, smoothed(1)).k1.empty());
}

TEST(CurvatureEstimator, StaysFiniteOnMessyMeshes) {
    Random random(8);
    TriangleMesh mesh = lumpy();
    for (int i = 0; i < 40; ++i)
        mesh.vertices.push_back(shapes::detail::vec3(random.normal(), random.normal(), 1e-6 * random.normal()));
    for (int i = 0; i < 300; ++i) {
        Face face;
        for (std::uint32_t& v : face) v = static_cast<std::uint32_t>(2542 + random.index(50));
        mesh.faces.push_back(face);
    }
    mesh.vertices.resize(2600, Vec3(9, 9, 9));
    for (const CurvatureOptions& options : k_kinds) {
        VertexCurvature c = estimated(mesh, options);
        c.derivative.resize(c.k1.size());
        expect_finite(c);
        EXPECT_EQ(c.k1.back(), 0);
    }
}

/// The errors of an estimate of a torus against another field on it.
double largest_difference(const std::vector<float>& a, const std::vector<float>& b) {
    double largest = 0;
    for (std::size_t i = 0; i < a.size(); ++i) largest = std::max<double>(largest, std::abs(a[i] - b[i]));
    return largest;
}

TEST(CurvatureSmoothing, AddsHalfTheVarianceTimesTheLaplacian) {
    // What a Gaussian does to leading order. On a torus k1 + k2 changes only along the tube (angle v, w = 3 + cos v):
    // (1 / w) d/dv (w d/dv (cos v / w)) = -3 (cos v / w^2 + sin^2 v / w^3).
    const TriangleMesh mesh = shapes::torus(3, 1, 360, 120);
    const VertexCurvature plain = estimated(mesh, {});
    for (const double width : {0.12, 0.24}) {
        const VertexCurvature c = estimated(mesh, smoothed(1, width));
        double error = 0, largest = 0;
        for (std::size_t i = 0; i < mesh.vertex_count(); ++i) {
            const double w = std::hypot(mesh.vertices[i].x(), mesh.vertices[i].y()), cosine = w - 3;
            const double laplacian = -3 * (cosine / (w * w) + (1 - cosine * cosine) / (w * w * w));
            const double change = double(c.k1[i]) + c.k2[i] - plain.k1[i] - plain.k2[i];
            error = std::max(error, std::abs(change - width * width / 2 * laplacian));
            largest = std::max(largest, std::abs(width * width / 2 * laplacian));
        }
        // The next order is that of width^4.
        EXPECT_LT(error / largest, 2.5 * width * width) << width;
    }
}

TEST(CurvatureSmoothing, ErrorGrowsWithTheSquareOfTheWidth) {
    const TriangleMesh mesh = shapes::torus(3, 1, 360, 120);
    const VertexCurvature plain = estimated(mesh, {});
    double last = 0;
    for (const double width : {0.1, 0.2, 0.4}) {
        const double error = largest_difference(estimated(mesh, smoothed(1, width)).k2, plain.k2);
        if (last > 0) {
            EXPECT_GT(error, 3.4 * last);
            EXPECT_LT(error, 4.3 * last);
        }
        last = error;
    }
}

TEST(CurvatureSmoothing, DoesNotDependOnTheSampling) {
    // Rings crowd on one side: the steps around the tube differ by a factor of 3.
    const auto uneven = [](const Vec3& p) {
        const double w = std::hypot(p.x(), p.y()), u = std::atan2(p.y(), p.x());
        double v = std::atan2(double(p.z()), w - 3);
        v += 0.5 * std::sin(v);
        return shapes::detail::vec3((3 + std::cos(v)) * std::cos(u), (3 + std::cos(v)) * std::sin(u), std::sin(v));
    };
    const auto mean_against_angle = [](const TriangleMesh& mesh) {
        // Of the smoothed mean curvature at the outer and at the inner equator.
        const VertexCurvature c = estimated(mesh, smoothed(1, 0.3));
        return std::array{c.k1[0] + c.k2[0], c.k1[30] + c.k2[30]};
    };
    const auto even = mean_against_angle(shapes::torus(3, 1, 180, 60));
    const auto crowded = mean_against_angle(shapes::transformed(shapes::torus(3, 1, 180, 60), uneven));
    const double effect = std::abs(even[0] - 1.25);
    EXPECT_NEAR(even[0], crowded[0], 0.15 * effect);
    EXPECT_NEAR(even[1], crowded[1], 0.15 * effect);
}

TEST(CurvatureSmoothing, KeepsParallelTensors) {
    const TriangleMesh mesh = shapes::cylinder(2, 6, 48, 40, false);
    const VertexCurvature c = estimated(mesh, smoothed(3));
    for (std::size_t i = 0; i < mesh.vertex_count(); ++i) {
        EXPECT_NEAR(c.k1[i], 0.5, 1e-4);
        EXPECT_NEAR(c.k2[i], 0, 1e-4);
        EXPECT_NEAR(std::abs(c.e2[i].z()), 1, 1e-4);
        for (float d : c.derivative[i]) EXPECT_NEAR(d, 0, 1e-4);
    }
}

TEST(CurvatureSmoothing, TakesNoiseAway) {
    Random random(5);
    const TriangleMesh mesh = shapes::transformed(shapes::icosphere(4, 1), [&](const Vec3& p) -> Vec3 {
        return p * (1 + 0.002f * static_cast<float>(random.normal()));
    });
    const auto error = [&](double width) {
        const VertexCurvature c = estimated(mesh, smoothed(width));
        double k = 0, d = 0;
        for (std::size_t i = 0; i < c.k1.size(); ++i) {
            k += std::pow(c.k1[i] - 1, 2) + std::pow(c.k2[i] - 1, 2);
            for (float x : c.derivative[i]) d += x * x;
        }
        return std::array{k, d};
    };
    const auto raw = error(0), one = error(1), two = error(2);
    EXPECT_LT(one[0], raw[0] / 4);
    EXPECT_LT(two[0], one[0] / 2);
    EXPECT_LT(one[1], raw[1] / 10);
    EXPECT_LT(two[1], one[1] / 4);
}

TEST(CurvatureSmoothing, UnitIsTheMedianEdge) {
    const TriangleMesh mesh = lumpy();
    CurvatureEstimator estimator(mesh.faces, mesh.vertex_count());
    const double unit = estimator.median_edge_length(mesh.vertices);
    const VertexCurvature relative = estimator.estimate(mesh.vertices, smoothed(1.5));
    expect_equal_bits(relative, estimator.estimate(mesh.vertices, smoothed(1.5, unit)));
    const TriangleMesh square = shapes::grid(5, 5, 10);
    // 60 edges of 2 and 25 diagonals.
    EXPECT_FLOAT_EQ(static_cast<float>(CurvatureEstimator(square.faces, 36).median_edge_length(square.vertices)), 2);
}

}  // namespace
}  // namespace exemplar
