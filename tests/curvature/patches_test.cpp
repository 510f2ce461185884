#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <set>
#include <vector>

#include "host/core/random.h"
#include "host/curvature/state/patches.h"
#include "host/curvature/state/segments.h"
#include "host/mesh/topology.h"
#include "tests/support/shapes.h"

namespace exemplar {
namespace {

std::vector<std::vector<std::uint32_t>> members(const std::vector<std::uint32_t>& patch_of_vertex) {
    std::vector<std::vector<std::uint32_t>> patches;
    for (std::uint32_t v = 0; v < patch_of_vertex.size(); ++v) {
        patches.resize(std::max<std::size_t>(patches.size(), patch_of_vertex[v] + 1));
        patches[patch_of_vertex[v]].push_back(v);
    }
    return patches;
}

/// Largest distance between two vertices of a patch.
float diameter(const std::vector<std::uint32_t>& patch, const std::vector<Vec3>& vertices) {
    float largest = 0;
    for (const std::uint32_t a : patch)
        for (const std::uint32_t b : patch) largest = std::max(largest, (vertices[a] - vertices[b]).norm());
    return largest;
}

TEST(Patches, AreAsFewAsCanBeAndNoneIsTooLarge) {
    const TriangleMesh mesh = shapes::grid(30, 17, 1);
    for (const std::size_t most : {1u, 7u, 16u, 32u, 100u, 10000u}) {
        const auto patches = members(surface_patches(mesh, most));
        EXPECT_EQ(patches.size(), (mesh.vertex_count() + most - 1) / most);
        for (const auto& patch : patches) {
            EXPECT_GE(patch.size(), 1u);
            EXPECT_LE(patch.size(), most);
        }
    }
    EXPECT_EQ(members(surface_patches(mesh, 0)).size(), 1u);
}

TEST(Patches, AreCompactAndThoseThatFollowEachOtherAreNear) {
    const TriangleMesh mesh = shapes::grid(63, 63, 1);  // 4096 vertices, a unit square
    const auto patches = members(surface_patches(mesh, 64));
    ASSERT_EQ(patches.size(), 64u);
    std::size_t far = 0;
    for (std::size_t p = 0; p < patches.size(); ++p) {
        // A square of 64 vertices has a diagonal of 0.16.
        EXPECT_LT(diameter(patches[p], mesh.vertices), 0.4f);
        if (p > 0) {
            std::vector<std::uint32_t> both = patches[p - 1];
            both.insert(both.end(), patches[p].begin(), patches[p].end());
            if (diameter(both, mesh.vertices) > 0.6f) ++far;
        }
    }
    EXPECT_LE(far, patches.size() / 8);
}

TEST(Patches, HaveOnePieceWherePiecesAreLargeEnough) {
    TriangleMesh mesh = shapes::grid(7, 7, 1);  // 64 vertices
    const TriangleMesh other = shapes::grid(15, 15, 1);
    for (const Vec3& p : other.vertices) mesh.vertices.push_back(p + Vec3(0.01f, 0, 0.01f));  // close, but not joined
    for (const Face& face : other.faces) mesh.faces.push_back({face[0] + 64, face[1] + 64, face[2] + 64});
    for (const auto& patch : members(surface_patches(mesh, 32)))
        EXPECT_EQ(patch.front() < 64, patch.back() < 64) << "a patch of both";
}

TEST(Patches, TakeVerticesWithoutEdgesAndVerticesInOnePlace) {
    TriangleMesh mesh;
    for (int i = 0; i < 100; ++i) mesh.vertices.emplace_back(i < 50 ? 0.0f : float(i), 0.0f, 0.0f);
    EXPECT_EQ(members(surface_patches(mesh, 8)).size(), 13u);
    EXPECT_TRUE(surface_patches({}, 8).empty());
}

/// Segments of a mesh turn with it, whatever part each is of.
void expect_to_turn(const TriangleMesh& mesh, const Segments& segments) {
    std::vector<Eigen::Matrix3f> before, after;
    segments.rotations_of_sequence(mesh.vertices, before);
    const Eigen::Matrix3f turn(Eigen::AngleAxisf(1.9f, Vec3(1, -2, 0.5f).normalized()));
    std::vector<Vec3> moved = mesh.vertices;
    for (Vec3& p : moved) p = turn * p + Vec3(5, 0, -3);
    segments.rotations_of_sequence(moved, after);
    for (std::size_t s = 0; s < before.size(); ++s)
        EXPECT_NEAR((after[s] - turn * before[s]).norm(), 0, 2e-3) << "segment " << s;
}

TEST(Segments, OfNarrowPartsTurnWithThem) {
    TriangleMesh crescent = shapes::grid(15, 1, 1);  // two rows
    for (Vec3& p : crescent.vertices) p = {p.x(), 0.02f * p.y() + 0.5f * p.x() * p.x(), 0.1f * p.x()};
    expect_to_turn(crescent, segment_patches(crescent, std::vector<std::uint32_t>(crescent.vertex_count(), 0)));
    // Whatever is left of a surface: patches of any small size.
    const TriangleMesh sheet = shapes::grid(20, 20, 1);
    for (std::uint32_t size = 4; size < 40; ++size) {
        std::vector<std::uint32_t> corner(sheet.vertex_count(), 0);
        for (std::uint32_t v = 0; v < size; ++v) corner[v % 3 * 21 + v / 3] = 1;
        expect_to_turn(sheet, segment_patches(sheet, corner));
    }
}

TEST(Segments, OnALineKeepTheAxesOfTheWorld) {
    TriangleMesh mesh;
    for (int i = 0; i < 9; ++i) mesh.vertices.push_back(0.37f * float(i) * Vec3(0.3f, 0.7f, -0.2f));
    for (const std::size_t count : {1u, 2u, 3u, 8u, 9u}) {
        TriangleMesh line;
        line.vertices.assign(mesh.vertices.begin(), mesh.vertices.begin() + std::ptrdiff_t(count));
        std::vector<Eigen::Matrix3f> rotations;
        segment_patches(line, std::vector<std::uint32_t>(count, 0)).rotations_of_sequence(line.vertices, rotations);
        EXPECT_EQ(rotations[0], Eigen::Matrix3f::Identity()) << count << " vertices";
    }
}

}  // namespace
}  // namespace exemplar
