#include "host/parts/prototype/mannequin.h"

#include <gtest/gtest.h>

#include <numbers>

#include "host/core/errors.h"
#include "host/mesh/editing/validate.h"
#include "host/mesh/io/io.h"
#include "host/parts/prototype/level_surface.h"
#include "host/parts/prototype/solid_distance.h"
#include "tests/parts/rigging/part_shapes.h"
#include "tests/support/manifold.h"
#include "tests/support/shapes.h"
#include "tests/support/temporary_folder.h"

namespace exemplar {
namespace {

/// A grid of the values of a function over [-2, 2]^3.
template <typename Value>
ValueGrid sampled_grid(std::uint32_t nodes, const Value& value) {
    ValueGrid grid;
    grid.size = {nodes, nodes, nodes};
    grid.cell = 4 / static_cast<float>(nodes - 1);
    grid.origin = Vec3::Constant(-2);
    for (std::uint32_t z = 0; z < nodes; ++z)
        for (std::uint32_t y = 0; y < nodes; ++y)
            for (std::uint32_t x = 0; x < nodes; ++x) grid.value.push_back(value(grid.position(x, y, z)));
    return grid;
}

TEST(LevelSurface, ABallHasItsVolume) {
    const TriangleMesh mesh = level_surface(sampled_grid(41, [](const Vec3& p) { return p.norm() - 1; }));
    EXPECT_TRUE(is_closed_and_oriented(mesh));
    EXPECT_TRUE(is_vertex_manifold(mesh));
    EXPECT_NEAR(signed_volume(mesh), 4 * std::numbers::pi / 3, 0.03);
    for (const Vec3& v : mesh.vertices) EXPECT_NEAR(v.norm(), 1, 0.01);
}

TEST(LevelSurface, AnyValuesGiveAClosedSurface) {
    std::uint64_t state = 1;
    const TriangleMesh mesh = level_surface(sampled_grid(12, [&](const Vec3& p) {
        state = state * 6364136223846793005U + 1442695040888963407U;
        return p.cwiseAbs().maxCoeff() > 1.9F || state >> 63 ? 1.0F : -1.0F;
    }));
    EXPECT_GT(mesh.face_count(), 1000U);
    EXPECT_TRUE(is_closed_and_oriented(mesh));
    EXPECT_TRUE(is_vertex_manifold(mesh));
}

TEST(SolidDistance, OfABallIsKnown) {
    const TriangleMesh ball = shapes::icosphere(4, 1);
    std::vector<std::uint32_t> faces;
    for (std::uint32_t f = 0; f < ball.face_count(); ++f) faces.push_back(f);
    const SurfaceDistance distance(ball, faces, 0.05F);
    const ValueGrid grid = sampled_grid(17, [](const Vec3&) { return 0.0F; });
    const std::vector<bool> inside = nodes_inside(ball, grid.size, grid.origin, grid.cell);
    for (std::uint32_t z = 0; z < 17; ++z)
        for (std::uint32_t y = 0; y < 17; ++y)
            for (std::uint32_t x = 0; x < 17; ++x) {
                const Vec3 p = grid.position(x, y, z);
                EXPECT_NEAR(distance(p), std::abs(p.norm() - 1), 0.01);
                if (std::abs(p.norm() - 1) > 0.02F) {
                    EXPECT_EQ(inside[grid.index(x, y, z)], p.norm() < 1);
                }
            }
}

/// An arm of 120 mm with a boundary at half its length; its radius is 10 mm.
Mannequin jointed_arm(const std::vector<std::string>& hinges, double gap = 0.5) {
    const TriangleMesh mesh = part_shapes::tube(12);
    MannequinOptions options;
    options.height = 120;
    options.resolution = 96;
    options.gap = gap;
    options.hinges = hinges;
    return make_mannequin(mesh, {"upper", "lower"}, part_shapes::labels_along_x(mesh, {6}), options);
}

TEST(Mannequin, SolidsAreClosedManifoldsThatDoNotTouch) {
    for (const std::vector<std::string>& hinges :
         {std::vector<std::string>{}, std::vector<std::string>{"lower", "upper"}}) {
        const Mannequin arm = jointed_arm(hinges);
        ASSERT_EQ(arm.solids.size(), 2U);
        ASSERT_EQ(arm.joints.size(), 1U);
        EXPECT_EQ(arm.joints[0].kind, hinges.empty() ? PrintJointKind::ball : PrintJointKind::hinge);
        double volume = 0;
        for (const PrintSolid& solid : arm.solids) {
            EXPECT_TRUE(is_closed_and_oriented(solid.mesh)) << solid.name;
            EXPECT_TRUE(is_vertex_manifold(solid.mesh)) << solid.name;
            volume += signed_volume(solid.mesh);
        }
        const double whole = 8 * std::sin(std::numbers::pi / 8) * 100 * 120;  // of the prism with 16 sides
        EXPECT_LT(volume, whole);
        EXPECT_GT(volume, 0.9 * whole);
        std::vector<std::uint32_t> faces;
        for (std::uint32_t f = 0; f < arm.solids[1].mesh.face_count(); ++f) faces.push_back(f);
        const SurfaceDistance distance(arm.solids[1].mesh, faces, 0.5F);
        float nearest = 1e9F;
        for (const Vec3& v : arm.solids[0].mesh.vertices) nearest = std::min(nearest, distance(v));
        EXPECT_GT(nearest, 0.3F) << "the gap is half a millimeter";
        EXPECT_LT(nearest, 0.7F);
    }
}

TEST(Mannequin, TheSocketHoldsTheBall) {
    const Mannequin arm = jointed_arm({});
    const PrintJoint& joint = arm.joints[0];
    EXPECT_NEAR(joint.radius, 6, 1) << "of the radius of 10 mm";
    // The opening of the socket, where the solids are divided, is narrower than the ball.
    const float depth = std::abs((joint.center - arm.skeleton.joints[1].head).dot(joint.inward));
    EXPECT_LT(std::sqrt(std::pow(joint.radius + 0.5F, 2) - std::pow(depth - 0.25F, 2)), joint.radius);
}

TEST(Mannequin, WhatIsTooThinForAJointIsOneSolid) {
    EXPECT_EQ(jointed_arm({}, 4).solids.size(), 1U);
    EXPECT_EQ(jointed_arm({}, 4).joints[0].kind, PrintJointKind::fused);
}

TEST(Mannequin, OpenSurfacesAreRefused) {
    const TriangleMesh mesh = shapes::grid(4, 4, 1);
    EXPECT_THROW(make_mannequin(mesh, {"a"}, std::vector<std::int32_t>(mesh.face_count(), 0)), MeshError);
}

}  // namespace
}  // namespace exemplar
