#include "host/synth/animations/cloth.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "host/mesh/curvature/curvature.h"
#include "host/mesh/topology.h"
#include "host/synth/animations/cloth_scenes.h"

namespace exemplar {
namespace {

const AnimationOptions k_options{3500, 60, 1, 1};

const Animation& cloth_animation(const std::string& kind) {
    static std::map<std::string, Animation> cache;
    if (!cache.contains(kind)) cache[kind] = make_animation(kind, k_options);
    return cache.at(kind);
}

ClothGrid small_grid() {
    return {20, 16, 1.0, 0.75};
}

std::vector<Vec3d> hanging(const ClothGrid& grid) {
    std::vector<Vec3d> positions;
    for (std::size_t r = 0; r < grid.rows; ++r)
        for (std::size_t c = 0; c < grid.columns; ++c)
            positions.emplace_back(static_cast<double>(c) * grid.cell_width(),
                                   static_cast<double>(r) * grid.cell_height(), 0);
    return positions;
}

ClothScene held_at_the_top(const ClothGrid& grid) {
    ClothScene scene;
    for (std::size_t c = 0; c < grid.columns; ++c)
        scene.pinned.push_back(static_cast<std::uint32_t>(grid.index(c, grid.rows - 1)));
    scene.pinned_position = [rest = hanging(grid)](std::uint32_t v, double) { return rest[v]; };
    return scene;
}

TEST(Cloth, FallsFreelyWhenNothingHoldsIt) {
    const ClothGrid grid = small_grid();
    Cloth cloth(grid, {}, hanging(grid), {});
    cloth.advance(0, 0.5);
    const std::vector<Vec3d> rest = hanging(grid);
    for (std::size_t v = 0; v < rest.size(); ++v) {
        const Vec3d expected = rest[v] - Vec3d(0, 0.5 * 9.81 * 0.25, 0);
        EXPECT_LT((cloth.positions()[v] - expected).norm(), 2e-3);  // the first order error of 1,000 steps
    }
}

TEST(Cloth, HangsAlmostUnstretchedAndComesToRest) {
    const ClothGrid grid = small_grid();
    Cloth cloth(grid, {}, hanging(grid), held_at_the_top(grid));
    cloth.advance(0, 0.05);
    const double early = cloth.kinetic_energy();
    cloth.advance(0.05, 3);
    EXPECT_GT(early, 0);
    EXPECT_LT(cloth.kinetic_energy(), 0.05 * early);
    for (std::size_t c = 0; c < grid.columns; ++c) {
        const double height =
            cloth.positions()[grid.index(c, grid.rows - 1)].y() - cloth.positions()[grid.index(c, 0)].y();
        EXPECT_NEAR(height, grid.height, 0.01 * grid.height);
    }
}

TEST(Cloth, PinnedParticlesAreWhereTheSceneWantsThem) {
    const ClothGrid grid = small_grid();
    ClothScene scene = held_at_the_top(grid);
    const auto position = [rest = hanging(grid)](std::uint32_t v, double time) {
        return Vec3d(rest[v] + Vec3d(0.1 * time, 0, std::sin(time)));
    };
    scene.pinned_position = position;
    scene.wind = [](const Vec3d&, double) { return Vec3d(1, 0, 6); };
    Cloth cloth(grid, {}, hanging(grid), scene);
    cloth.advance(0, 0.7);
    for (const std::uint32_t v : scene.pinned) EXPECT_LT((cloth.positions()[v] - position(v, 0.7)).norm(), 1e-9);
}

/// How far a strip sags whose first two columns lie on a shelf.
double sag_over_an_edge(const ClothGrid& grid, double bending) {
    ClothScene scene;
    for (std::size_t r = 0; r < grid.rows; ++r)
        for (std::size_t c = 0; c < 2; ++c) scene.pinned.push_back(static_cast<std::uint32_t>(grid.index(c, r)));
    std::vector<Vec3d> flat;
    for (const Vec3d& p : hanging(grid)) flat.emplace_back(p.x(), 0, -p.y());
    scene.pinned_position = [flat](std::uint32_t v, double) { return flat[v]; };
    scene.wind = [](const Vec3d&, double) { return Vec3d(Vec3d::Zero()); };
    Cloth cloth(grid, {.bending = bending}, flat, scene);
    cloth.advance(0, 2);
    return -cloth.positions()[grid.index(grid.columns - 1, grid.rows / 2)].y();
}

TEST(Cloth, SagsOverAnEdgeLikeABeamOfItsWeightAndStiffness) {
    const ClothGrid grid{8, 8, 1.4, 1.4};
    // Small slopes: n free particles of weight w each load the joints, the bending moment at the m-th from the end
    // being w dx m (m + 1) / 2 and its curvature that over the stiffness, which lowers the end by curvature dx (m dx).
    const double dx = grid.cell_width(), weight = 0.18 * 9.81 * dx, n = static_cast<double>(grid.columns) - 2;
    const double sum = (std::pow(n * (n + 1) / 2, 2) + n * (n + 1) * (2 * n + 1) / 6) / 2;
    for (const double bending : {4.0, 8.0}) {
        const double beam = weight * std::pow(dx, 3) * sum / bending;
        EXPECT_NEAR(sag_over_an_edge(grid, bending), beam, 0.08 * beam);
    }
    EXPECT_GT(sag_over_an_edge(grid, 1e-3), 0.8 * (grid.width - dx));
}

TEST(ClothSurface, IsADiskOfWellShapedTrianglesSeenFromItsFront) {
    const ClothGrid grid = small_grid();
    const ClothSurface surface(grid, 1000, 7);
    TriangleMesh mesh;
    mesh.vertices = surface.vertices(hanging(grid));
    mesh.faces = surface.faces();
    const Topology topology = build_topology(mesh);
    EXPECT_EQ(static_cast<long>(mesh.vertex_count() + mesh.face_count()) - static_cast<long>(topology.edges.size()), 1);
    for (const Vec3& normal : face_normals(mesh)) EXPECT_NEAR(normal.z(), 1, 1e-4);
    float area = 0;
    for (const float a : face_areas(mesh)) area += a;
    EXPECT_NEAR(area, 0.75, 1e-4);
    for (const Edge& edge : topology.edges) {
        const float length = (mesh.vertices[edge.vertex[0]] - mesh.vertices[edge.vertex[1]]).norm();
        EXPECT_GT(length, 0.35f * std::sqrt(0.75f / 1000));
        EXPECT_LT(length, 2.0f * std::sqrt(0.75f / 1000));
    }
}

TEST(ClothSurface, FollowsACylinderWithItsCurvature) {
    ClothGrid grid{41, 31, 2.0, 1.5};
    std::vector<Vec3d> particles;
    for (const Vec3d& p : hanging(grid)) particles.emplace_back(std::sin(p.x()), p.y(), std::cos(p.x()));
    const ClothSurface surface(grid, 4000, 3);
    TriangleMesh mesh;
    mesh.vertices = surface.vertices(particles);
    mesh.faces = surface.faces();
    const VertexCurvature curvature = estimate_curvature(mesh, false);
    for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
        const float angle = std::atan2(mesh.vertices[v].x(), mesh.vertices[v].z());
        if (angle < 0.2f || angle > 1.8f || mesh.vertices[v].y() < 0.2f || mesh.vertices[v].y() > 1.3f) continue;
        EXPECT_NEAR(curvature.k1[v], 1, 0.05);
        EXPECT_NEAR(curvature.k2[v], 0, 0.05);
    }
}

class ClothOfKind : public testing::TestWithParam<std::string> {};

TEST_P(ClothOfKind, KeepsItsEdgeLengths) {
    const Animation& animation = cloth_animation(GetParam());
    const Topology topology = build_topology(animation.rest);
    std::vector<float> ratios;
    for (const std::vector<Vec3>& frame : animation.clips.front().frames) {
        for (const Edge& edge : topology.edges) {
            const auto [a, b] = edge.vertex;
            const float rest = (animation.rest.vertices[a] - animation.rest.vertices[b]).norm();
            ratios.push_back((frame[a] - frame[b]).norm() / rest);
        }
    }
    std::sort(ratios.begin(), ratios.end());
    EXPECT_NEAR(ratios[ratios.size() / 2], 1, 0.01);
    EXPECT_GT(ratios[ratios.size() / 50], 0.9f);
    EXPECT_LT(ratios[ratios.size() * 98 / 100], 1.03f);
    EXPECT_LT(ratios.back(), 1.15f);
}

TEST_P(ClothOfKind, MovesWithoutJumps) {
    const Clip& clip = cloth_animation(GetParam()).clips.front();
    const float limit = GetParam() == "flag" ? 20.0f : 6.0f;  // meters per second; the corner of a flag cracks
    for (std::size_t f = 1; f < clip.size(); ++f) {
        for (std::size_t v = 0; v < clip.frames[f].size(); ++v) {
            ASSERT_TRUE(clip.frames[f][v].allFinite());
            EXPECT_LT((clip.frames[f][v] - clip.frames[f - 1][v]).norm() * 30, limit) << "frame " << f;
        }
    }
}

/// Share of the mean curvature's variation that is not shared by the neighbors of a vertex: noise, if it is large.
double roughness(const TriangleMesh& mesh) {
    const VertexCurvature curvature = estimate_curvature(mesh, false);
    const Topology topology = build_topology(mesh);
    std::vector<bool> is_inner(mesh.vertex_count(), true);
    std::vector<double> sum(mesh.vertex_count(), 0), count(mesh.vertex_count(), 0);
    const auto mean = [&](std::size_t v) { return static_cast<double>(curvature.k1[v] + curvature.k2[v]) / 2; };
    for (const Edge& edge : topology.edges) {
        const auto [a, b] = edge.vertex;
        if (edge.is_boundary()) is_inner[a] = is_inner[b] = false;
        sum[a] += mean(b);
        sum[b] += mean(a);
        ++count[a];
        ++count[b];
    }
    double rough = 0, total = 0;
    for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
        if (!is_inner[v]) continue;
        rough += std::pow(mean(v) - sum[v] / count[v], 2);
        total += std::pow(mean(v), 2);
    }
    return rough / total;
}

TEST_P(ClothOfKind, HasCurvatureThatVariesSmoothlyFromVertexToVertex) {
    const Animation& animation = cloth_animation(GetParam());
    TriangleMesh mesh = animation.rest;
    for (const std::size_t frame : {std::size_t{20}, std::size_t{40}, std::size_t{59}}) {
        mesh.vertices = animation.clips.front().frames[frame];
        EXPECT_LT(roughness(mesh), 0.05) << "frame " << frame;
    }
}

INSTANTIATE_TEST_SUITE_P(Kinds, ClothOfKind, testing::Values("flag", "curtain", "drape"),
                         [](const auto& kind) { return kind.param; });

TEST(ClothScenes, FlagStaysAtItsPole) {
    const Animation& flag = cloth_animation("flag");
    std::size_t held = 0;
    for (std::size_t v = 0; v < flag.rest.vertex_count(); ++v) {
        if (flag.rest.vertices[v].x() > 1e-6f) continue;
        ++held;
        for (const auto& frame : flag.clips.front().frames) EXPECT_LT((frame[v] - flag.rest.vertices[v]).norm(), 1e-5f);
    }
    EXPECT_GT(held, 20u);
}

TEST(ClothScenes, CurtainHangsFromItsRod) {
    const Animation& curtain = cloth_animation("curtain");
    float top = 0;
    for (const Vec3& p : curtain.rest.vertices) top = std::max(top, p.y());
    for (const auto& frame : curtain.clips.front().frames) {
        float highest = 0, lowest = top;
        for (std::size_t v = 0; v < frame.size(); ++v) {
            highest = std::max(highest, frame[v].y());
            if (curtain.rest.vertices[v].y() > top - 1e-6f) lowest = std::min(lowest, frame[v].y());
        }
        EXPECT_NEAR(highest, top, 0.03f);
        EXPECT_GT(lowest, top - 0.2f);  // the upper edge sags between its rings only
    }
}

TEST(ClothScenes, DrapeStaysOutsideOfTheBallAndOnTopOfIt) {
    const Animation& drape = cloth_animation("drape");
    const auto ball = drape_ball(k_options);
    const Clip& clip = drape.clips.front();
    for (std::size_t f = 0; f < clip.size(); ++f) {
        const Ball3 at = ball(static_cast<double>(f) / 30);
        float nearest = 1e9f;
        for (const Vec3& p : clip.frames[f])
            nearest = std::min(nearest, (p - at.center.cast<float>()).norm() - static_cast<float>(at.radius));
        EXPECT_GT(nearest, -0.002f) << "frame " << f;
        EXPECT_TRUE(f < 20 || nearest < 0.03f) << "frame " << f;
    }
}

}  // namespace
}  // namespace exemplar
