#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "host/core/parallel.h"
#include "host/mesh/queries/axes.h"
#include "tests/support/shapes.h"

namespace exemplar {
namespace {

const double k_cos_1_degree = std::cos(0.0174533), k_cos_20_degrees = std::cos(20 * 0.0174533);

/// Whether some of `planes` has the normal `n` up to sign and one degree.
testing::AssertionResult has_normal(const std::vector<SymmetryPlane>& planes, const Vec3& n) {
    for (const SymmetryPlane& plane : planes)
        if (std::abs(plane.normal.dot(n)) > k_cos_1_degree) return testing::AssertionSuccess();
    auto failure = testing::AssertionFailure() << "no normal near " << n.transpose() << " among";
    for (const SymmetryPlane& plane : planes) failure << " [" << plane.normal.transpose() << "]";
    return failure;
}

/// A closed bumpy surface that the plane y = 0 mirrors, and with `lopsided` none does. Its triangles have no symmetry.
TriangleMesh bilateral_blob(float lopsided) {
    const TriangleMesh sphere = shapes::rotated(shapes::icosphere(4, 1), shapes::random_rotation(99));
    return shapes::transformed(sphere, [=](const Vec3& p) -> Vec3 {
        return p * (1 + 0.3f * std::sin(2.5f * p.x() + 1) * p.z() + 0.25f * std::cos(3 * p.z() + p.x()) +
                    0.35f * std::abs(p.y()) * p.x() + lopsided * p.y() * p.x());
    });
}

TEST(PrincipalAxes, OfABoxShellAreAnalyticForAnyTessellation) {
    // Along the side s with the others a, b: the two faces across have s^2 / 4, the four along it s^2 / 12.
    const auto variance = [](double s, double a, double b) {
        return s * s * (2 * a * b / 4 + 2 * s * (a + b) / 12) / (2 * (s * a + s * b + a * b));
    };
    for (const std::uint32_t n : {1u, 6u}) {
        const PrincipalAxes axes = principal_axes(shapes::translated(shapes::box(1, 2, 3, n), {5, 6, 7}));
        EXPECT_LT((axes.center - Vec3(5, 6, 7)).norm(), 1e-5f);
        EXPECT_NEAR(axes.sigma[0], std::sqrt(variance(3, 1, 2)), 1e-5);
        EXPECT_NEAR(axes.sigma[1], std::sqrt(variance(2, 1, 3)), 1e-5);
        EXPECT_NEAR(axes.sigma[2], std::sqrt(variance(1, 2, 3)), 1e-5);
        for (int i = 0; i < 3; ++i) EXPECT_NEAR(std::abs(axes.axis[i][2 - i]), 1, 1e-6);
    }
}

TEST(PrincipalAxes, TurnWithTheMesh) {
    const Eigen::Matrix3f rotation = shapes::random_rotation(2);
    const PrincipalAxes a = principal_axes(bilateral_blob(0.2f)),
                        b = principal_axes(shapes::rotated(bilateral_blob(0.2f), rotation));
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR((rotation * a.axis[i]).dot(b.axis[i]), 1, 1e-5);
        EXPECT_NEAR(a.sigma[i], b.sigma[i], 1e-5);
        EXPECT_NEAR(b.axis[i].dot(b.axis[(i + 1) % 3]), 0, 1e-5);
    }
}

TEST(PrincipalAxes, PointToTheLongTail) {
    // A wedge is widest at x = 0 and ends in a tip at x = 3: most of it lies behind its center, its tail ahead.
    TriangleMesh wedge;
    wedge.vertices = {{0, -1, 0}, {3, 0, 0}, {0, 1, 0}};
    wedge.faces = {{0, 1, 2}};
    EXPECT_NEAR(principal_axes(wedge).axis[0].x(), 1, 1e-6);
    wedge.vertices[1].x() = -3;
    EXPECT_NEAR(principal_axes(wedge).axis[0].x(), -1, 1e-6);
}

TEST(PrincipalAxes, OfDegenerateMeshesAreStillAxes) {
    TriangleMesh line;
    line.vertices = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
    line.faces = {{0, 1, 2}};
    for (const TriangleMesh& mesh : {TriangleMesh{}, line}) {
        const PrincipalAxes axes = principal_axes(mesh);
        for (std::size_t i = 0; i < 3; ++i) {
            EXPECT_NEAR(axes.axis[i].norm(), 1, 1e-6);
            EXPECT_EQ(axes.sigma[i], 0);
        }
    }
}

TEST(SymmetryPlanes, OfABoxAreItsThree) {
    for (const std::uint32_t n : {1u, 8u}) {
        const auto planes = symmetry_planes(shapes::box(1, 2, 3, n));
        ASSERT_EQ(planes.size(), 3u);
        for (int i = 0; i < 3; ++i) EXPECT_TRUE(has_normal(planes, Vec3::Unit(i)));
        for (const SymmetryPlane& plane : planes) EXPECT_LT(plane.error, 1e-3f);
    }
}

TEST(SymmetryPlanes, OfABilateralBlobBeginWithItsPlane) {
    const auto planes = symmetry_planes(bilateral_blob(0));
    EXPECT_TRUE(has_normal({planes[0]}, Vec3::UnitY()));
    EXPECT_LT(planes[0].error, 1e-3f);
    EXPECT_GT(planes[1].error, 10 * planes[0].error);
    EXPECT_GT(symmetry_planes(bilateral_blob(0.2f))[0].error, 10 * planes[0].error);
}

TEST(SymmetryPlanes, AreFoundOffThePrincipalAxes) {
    // A square plate has its diagonals as mirrors, wherever the degenerate principal axes fall.
    const Eigen::Matrix3f rotation = shapes::random_rotation(5);
    const auto planes = symmetry_planes(shapes::rotated(shapes::box(2, 2, 0.5f, 6), rotation), 5);
    for (const Vec3& n : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(1, 1, 0), Vec3(1, -1, 0)})
        EXPECT_TRUE(has_normal(planes, rotation * n.normalized()));
    for (const SymmetryPlane& plane : planes) EXPECT_LT(plane.error, 3e-3f);
}

TEST(SymmetryPlanes, TurnWithTheMeshAndIgnoreItsScaleAndFaceOrder) {
    const Eigen::Matrix3f rotation = shapes::random_rotation(8);
    const TriangleMesh mesh = bilateral_blob(0);
    const TriangleMesh moved = shapes::with_shuffled_faces(
        shapes::translated(shapes::scaled(shapes::rotated(mesh, rotation), 50), {10, 20, 30}), 4);
    const auto a = symmetry_planes(mesh), b = symmetry_planes(moved);
    EXPECT_TRUE(has_normal({b[0]}, rotation * Vec3::UnitY()));
    EXPECT_NEAR(a[0].error, b[0].error, 2e-4);
    EXPECT_LT((b[0].point - Vec3(10, 20, 30) - 50 * (rotation * a[0].point)).norm(), 1e-2f);
}

TEST(SymmetryPlanes, AreSeparatedOrderedAndAsManyAsAsked) {
    for (const TriangleMesh& mesh : {shapes::icosphere(3, 1), bilateral_blob(0.2f), shapes::torus(3, 1, 30, 15)}) {
        const auto planes = symmetry_planes(mesh, 4);
        ASSERT_EQ(planes.size(), 4u);
        EXPECT_TRUE(std::ranges::is_sorted(planes, {}, &SymmetryPlane::error));
        for (std::size_t i = 0; i < 4; ++i) {
            EXPECT_NEAR(planes[i].normal.norm(), 1, 1e-5);
            for (std::size_t j = 0; j < i; ++j)
                EXPECT_LT(std::abs(planes[i].normal.dot(planes[j].normal)), k_cos_20_degrees + 1e-6);
        }
    }
    EXPECT_TRUE(symmetry_planes(shapes::box(1, 2, 3, 1), 0).empty());
}

TEST(SymmetryPlanes, DoNotDependOnThreads) {
    const auto many = symmetry_planes(bilateral_blob(0.2f));
    const ThreadLimit limit(1);
    const auto one = symmetry_planes(bilateral_blob(0.2f));
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(many[i].normal, one[i].normal);
        EXPECT_EQ(many[i].error, one[i].error);
    }
}

TEST(SymmetryPlanes, OfDegenerateMeshesArePrincipalPlanes) {
    TriangleMesh point;
    point.vertices = {{1, 1, 1}};
    point.faces = {{0, 0, 0}};
    for (const TriangleMesh& mesh : {TriangleMesh{}, point}) {
        const auto planes = symmetry_planes(mesh, 3);
        ASSERT_EQ(planes.size(), 3u);
        for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(planes[i].normal, principal_axes(mesh).axis[i]);
        for (const SymmetryPlane& plane : planes) EXPECT_EQ(plane.error, 0);
    }
}

}  // namespace
}  // namespace exemplar
