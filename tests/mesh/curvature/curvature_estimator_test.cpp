#include "host/mesh/curvature/curvature_estimator.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

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
TriangleMesh lumpy_sphere() {
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
CurvatureOptions robust(RobustEstimator estimator) {
    CurvatureOptions options;
    options.robust = estimator;
    return options;
}
const CurvatureOptions k_kinds[] = {
    {}, {true, 1.5}, {false, 1}, robust(RobustEstimator::cauchy), {true, 1, 0, RobustEstimator::geman_mcclure}};

TEST(CurvatureEstimator, GivesWhatTheOneOffFunctionGives) {
    const TriangleMesh mesh = lumpy_sphere();
    CurvatureEstimator estimator(mesh.faces, mesh.vertex_count());
    expect_equal_bits(estimator.estimate(mesh.vertices), estimate_curvature(mesh, true));
    CurvatureOptions no_derivatives;
    no_derivatives.derivatives = false;
    expect_equal_bits(estimator.estimate(mesh.vertices, no_derivatives), estimate_curvature(mesh, false));
}

TEST(CurvatureEstimator, HasTheNormalsOfTheMesh) {
    TriangleMesh mesh = lumpy_sphere();
    mesh.vertices.push_back({5, 5, 5});
    mesh.faces.push_back({1, 1, 2});
    CurvatureEstimator estimator(mesh.faces, mesh.vertex_count());
    estimator.estimate(mesh.vertices);
    const std::vector<Vec3> normals = vertex_normals(mesh);
    for (std::size_t i = 0; i < normals.size(); ++i) EXPECT_LT((estimator.normals()[i] - normals[i]).norm(), 1e-6) << i;
}

TEST(CurvatureEstimator, RemembersNothingOfEarlierPoses) {
    const TriangleMesh mesh = lumpy_sphere(),
                       other = shapes::scaled(shapes::rotated(lumpy_sphere(), shapes::random_rotation(3)), 2);
    for (const CurvatureOptions& options : k_kinds) {
        CurvatureEstimator estimator(mesh.faces, mesh.vertex_count());
        const VertexCurvature first = estimator.estimate(mesh.vertices, options);
        for (const CurvatureOptions& between : k_kinds) estimator.estimate(other.vertices, between);
        expect_equal_bits(estimator.estimate(mesh.vertices, options), first);
    }
}

TEST(CurvatureEstimator, DoesNotDependOnThreads) {
    const TriangleMesh mesh = shapes::torus(3, 1, 110, 50);
    for (const CurvatureOptions& options : k_kinds) {
        const VertexCurvature many = estimated(mesh, options);
        const ThreadLimit limit(1);
        expect_equal_bits(many, estimated(mesh, options));
    }
}

TEST(CurvatureEstimator, RefusesWhatDoesNotFit) {
    const TriangleMesh mesh = lumpy_sphere();
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
    TriangleMesh mesh = lumpy_sphere();
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

class EveryCurvature : public testing::TestWithParam<CurvatureOptions> {
  protected:
    CurvatureOptions options() const {
        CurvatureOptions with_derivatives = GetParam();
        with_derivatives.derivatives = true;
        return with_derivatives;
    }
};

/// Compares where directions are well defined; `scale` is the ratio of the units of length.
void expect_same_estimate(const VertexCurvature& a, const VertexCurvature& b, const Eigen::Matrix3f& rotation,
                          float scale, float tolerance) {
    std::size_t compared = 0;
    for (std::size_t i = 0; i < a.k1.size(); ++i) {
        EXPECT_NEAR(a.k1[i], b.k1[i] * scale, tolerance) << i;
        EXPECT_NEAR(a.k2[i], b.k2[i] * scale, tolerance) << i;
        if (a.k1[i] - a.k2[i] < 0.3f) continue;
        ++compared;
        const float along = (rotation * a.e1[i]).dot(b.e1[i]), sign = along > 0 ? 1.0f : -1.0f;
        EXPECT_NEAR(std::abs(along), 1, tolerance) << i;
        for (std::size_t k = 0; k < 4; ++k)
            EXPECT_NEAR(a.derivative[i][k], sign * b.derivative[i][k] * scale * scale, 10 * tolerance) << i;
    }
    EXPECT_GT(compared, a.k1.size() / 4);
}

TEST_P(EveryCurvature, MovesWithRigidMotionsAndScales) {
    const Eigen::Matrix3f rotation = shapes::random_rotation(6);
    const TriangleMesh mesh = lumpy_sphere();
    const TriangleMesh moved =
        shapes::translated(shapes::scaled(shapes::rotated(lumpy_sphere(), rotation), 0.01f), {0.003f, -0.002f, 0.005f});
    expect_same_estimate(estimated(mesh, options()), estimated(moved, options()), rotation, 0.01f, 5e-3f);
}

TEST_P(EveryCurvature, TurnedInsideOutChangesSignAndOrder) {
    TriangleMesh inverted = lumpy_sphere();
    for (Face& face : inverted.faces) std::swap(face[0], face[1]);
    VertexCurvature b = estimated(inverted, options());
    // The same directions change places and, with the normal, one changes its sign: (e1, e2) of the one side is
    // (e2, e1) of the other. All curvatures and derivatives change their sign.
    std::swap(b.k1, b.k2);
    std::swap(b.e1, b.e2);
    for (std::size_t i = 0; i < b.k1.size(); ++i) {
        b.k1[i] = -b.k1[i];
        b.k2[i] = -b.k2[i];
        const auto [c111, c112, c122, c222] = b.derivative[i];
        b.derivative[i] = {-c222, -c122, -c112, -c111};
    }
    expect_same_estimate(estimated(lumpy_sphere(), options()), b, Eigen::Matrix3f::Identity(), 1, 2e-3f);
}

TEST_P(EveryCurvature, OfASaddleConvergesAtSecondOrder) {
    // The monkey saddle z = (x^3 - 3 x y^2) / 6 + (x^2 - y^2) / 2, at its middle: curvatures along y and x are 1 and
    // -1, and the derivative is minus the third derivatives of the height, as the normal is up.
    const auto error = [&](std::uint32_t n) {
        const TriangleMesh mesh = shapes::transformed(shapes::grid(n, n, 1), [](const Vec3& p) {
            const double x = double(p.x()) - 0.5, y = double(p.y()) - 0.5;
            return shapes::detail::vec3(x, y, (x * x * x - 3 * x * y * y) / 6 + (x * x - y * y) / 2);
        });
        CurvatureOptions absolute = options();
        absolute.smoothing_unit = 1.0 / n;
        const VertexCurvature c = estimated(mesh, absolute);
        const std::size_t middle = n / 2 * (n + 1) + n / 2;
        // e1 along +-y, e2 along -+x: h_yyy = 0, h_yyx = -1, h_yxx = 0, h_xxx = 1.
        const float sign = c.e1[middle].y() > 0 ? 1.0f : -1.0f;
        const std::array<float, 4> truth = {0, -sign, 0, sign};
        std::array<double, 2> result = {std::max(std::abs(c.k1[middle] - 1), std::abs(c.k2[middle] + 1)), 0};
        for (std::size_t k = 0; k < 4; ++k)
            result[1] = std::max<double>(result[1], std::abs(c.derivative[middle][k] - truth[k]));
        return result;
    };
    const auto coarse = error(16), fine = error(32);
    EXPECT_LT(fine[0], coarse[0] / 3.3);
    EXPECT_LT(fine[1], coarse[1] / 3.0);
    EXPECT_LT(fine[0], 0.03);
    EXPECT_LT(fine[1], 0.06);
}

INSTANTIATE_TEST_SUITE_P(AllKinds, EveryCurvature, testing::ValuesIn(k_kinds),
                         [](const auto& kind) { return "Kind" + std::to_string(kind.index); });

double largest_difference(const std::vector<float>& a, const std::vector<float>& b) {
    double largest = 0;
    for (std::size_t i = 0; i < a.size(); ++i) largest = std::max<double>(largest, std::abs(a[i] - b[i]));
    return largest;
}

TEST(CurvatureSmoothing, AddsHalfTheVarianceTimesTheLaplacian) {
    // What a Gaussian does to leading order. On a torus k1 + k2 changes only along the tube (angle v, w = 3 + cos v):
    // (1 / w) d/dv (w d/dv (cos v / w)) = -3 (cos v / w^2 + sin^2 v / w^3).
    const TriangleMesh mesh = shapes::torus(3, 1, 240, 80);
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
    const TriangleMesh mesh = shapes::torus(3, 1, 240, 80);
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
    const TriangleMesh mesh = lumpy_sphere();
    CurvatureEstimator estimator(mesh.faces, mesh.vertex_count());
    const double unit = estimator.median_edge_length(mesh.vertices);
    const VertexCurvature relative = estimator.estimate(mesh.vertices, smoothed(1.5));
    expect_equal_bits(relative, estimator.estimate(mesh.vertices, smoothed(1.5, unit)));
    const TriangleMesh square = shapes::grid(5, 5, 10);
    // 60 edges of 2 and 25 diagonals.
    EXPECT_FLOAT_EQ(static_cast<float>(CurvatureEstimator(square.faces, 36).median_edge_length(square.vertices)), 2);
}

class RobustCurvature : public testing::TestWithParam<RobustEstimator> {};

/// Errors of curvature and of its derivative.
struct TensorErrors {
    double curvature, derivative;
};
/// Root mean squares.
TensorErrors errors_on_sphere(const TriangleMesh& mesh, const CurvatureOptions& options) {
    const VertexCurvature c = estimated(mesh, options);
    TensorErrors sum{0, 0};
    for (std::size_t i = 0; i < c.k1.size(); ++i) {
        sum.curvature += std::pow(c.k1[i] - 1, 2) + std::pow(c.k2[i] - 1, 2);
        for (float d : c.derivative[i]) sum.derivative += d * d;
    }
    const auto count = static_cast<double>(c.k1.size());
    return {std::sqrt(sum.curvature / (2 * count)), std::sqrt(sum.derivative / (4 * count))};
}

TEST_P(RobustCurvature, SuffersLessFromNoiseAndOutliers) {
    Random random(5);
    const TriangleMesh noisy = shapes::transformed(shapes::icosphere(4, 1), [&](const Vec3& p) -> Vec3 {
        const double outlier = random.index(60) == 0 ? random.uniform(-0.03, 0.03) : 0.0;
        return p * static_cast<float>(1 + 0.0005 * random.normal() + outlier);
    });
    const TensorErrors plain = errors_on_sphere(noisy, {}), better = errors_on_sphere(noisy, robust(GetParam()));
    EXPECT_LT(better.curvature, plain.curvature / 2);
    EXPECT_LT(better.derivative, plain.derivative / 4);
}

TEST_P(RobustCurvature, ConvergesAtSecondOrderOnCleanSurfaces) {
    const auto errors = [](std::uint32_t n) {
        const TriangleMesh mesh = shapes::torus(3, 1, 2 * n, n);
        const VertexCurvature c = estimated(mesh, robust(GetParam()));
        TensorErrors largest{0, 0};
        for (std::size_t i = 0; i < mesh.vertex_count(); ++i) {
            const double w = std::hypot(mesh.vertices[i].x(), mesh.vertices[i].y());
            const double slope = std::abs(3 * mesh.vertices[i].z() / (w * w));  // of k2 along e1; the rest is zero
            largest.curvature = std::max({largest.curvature, std::abs(c.k1[i] - 1.0), std::abs(c.k2[i] - (w - 3) / w)});
            largest.derivative = std::max(largest.derivative, std::abs(std::abs(c.derivative[i][2]) - slope));
        }
        return largest;
    };
    TensorErrors coarse = errors(16);
    for (const std::uint32_t n : {32u, 64u}) {
        const TensorErrors fine = errors(n);
        EXPECT_LT(fine.curvature, coarse.curvature / 3) << n;
        EXPECT_LT(fine.derivative, coarse.derivative / 3) << n;
        coarse = fine;
    }
    EXPECT_LT(coarse.curvature, 0.01);
    EXPECT_LT(coarse.derivative, 0.03);
}

TEST_P(RobustCurvature, KeepsACreaseToItself) {
    // Two planes that meet at a right angle over the middle of a grid.
    const TriangleMesh mesh = shapes::transformed(shapes::grid(20, 20, 20), [](const Vec3& p) -> Vec3 {
        return {p.x(), p.y(), -std::abs(p.x() - 10)};
    });
    const auto at_ring = [&](const CurvatureOptions& options, std::size_t ring) {
        const VertexCurvature c = estimated(mesh, options);
        return double(c.k1[10 * 21 + 10 + ring]);
    };
    const CurvatureOptions options = robust(GetParam());
    // Plain fits see half of the crease a ring away from it.
    EXPECT_NEAR(at_ring({}, 1), 0.5 * at_ring({}, 0), 0.01);
    EXPECT_LT(at_ring(options, 1), 0.3 * at_ring(options, 0));
    EXPECT_GE(at_ring(options, 0), at_ring({}, 0));
}

INSTANTIATE_TEST_SUITE_P(BothEstimators, RobustCurvature,
                         testing::Values(RobustEstimator::cauchy, RobustEstimator::geman_mcclure),
                         [](const auto& estimator) {
                             return estimator.param == RobustEstimator::cauchy ? "Cauchy" : "GemanMcClure";
                         });

TEST(RobustCurvatureOfFans, IsFinite) {
    // Around the tip of a cone each vertex has all others in two rings.
    TriangleMesh mesh;
    constexpr std::uint32_t k_around = 400;
    mesh.vertices.push_back({0, 0, 1});
    for (std::uint32_t i = 0; i < k_around; ++i) {
        const double u = 6.283185307179586 * i / k_around;
        mesh.vertices.push_back(shapes::detail::vec3(std::cos(u), std::sin(u), 0));
        mesh.faces.push_back({0, 1 + i, 1 + (i + 1) % k_around});
    }
    expect_finite(estimated(mesh, robust(RobustEstimator::geman_mcclure)));
}

}  // namespace
}  // namespace exemplar
