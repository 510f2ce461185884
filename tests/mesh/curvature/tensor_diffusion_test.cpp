#include "host/mesh/curvature/tensor_diffusion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "host/core/errors.h"
#include "tests/support/shapes.h"

namespace exemplar {
namespace {

/// A cone of many thin faces: its edges at the tip are far longer than those around its base.
TriangleMesh cone(std::uint32_t sides) {
    TriangleMesh mesh;
    mesh.vertices.push_back({0, 0, 1});
    for (std::uint32_t i = 0; i < sides; ++i) {
        const double angle = 2 * std::numbers::pi * i / sides;
        mesh.vertices.push_back({static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle)), 0});
        mesh.faces.push_back({0, 1 + i, 1 + (i + 1) % sides});
    }
    return mesh;
}

constexpr std::size_t k_all = 1'000'000, k_megabyte = 1 << 20;

void prepare(const TriangleMesh& mesh, double width, std::size_t max_bytes, std::size_t enough) {
    std::vector<TangentFrame> frames;
    for (const Vec3& vertex : mesh.vertices) frames.push_back(frame_of_normal(vertex.normalized()));
    const VertexNeighbors neighbors = build_vertex_neighbors(mesh.faces, mesh.vertex_count());
    TensorDiffusion diffusion(neighbors, max_bytes);
    diffusion.prepare(mesh.vertices, frames, std::vector<float>(mesh.vertex_count(), 1), width, enough);
}

// Every kernel of the cone holds about a third of it: the square of its vertices in all, which must not fill the
// memory.
TEST(TensorDiffusion, RefusesKernelsThatFillTheMemory) {
    EXPECT_NO_THROW(prepare(shapes::icosphere(4, 1), 0.05, k_megabyte, k_all));
    EXPECT_NO_THROW(prepare(cone(100), 0.5, k_megabyte, k_all));
    EXPECT_THROW(prepare(cone(1000), 0.5, k_megabyte, k_all), UsageError);
}

TEST(TensorDiffusion, HasBoundedKernelsOnAnyMesh) {
    EXPECT_NO_THROW(prepare(cone(1000), 0.5, k_megabyte, 32));
    // Rings around a vertex of a dense ball hold more and more of it, until there are enough.
    EXPECT_THROW(prepare(shapes::icosphere(4, 1), 3, k_megabyte, k_all), UsageError);
    EXPECT_NO_THROW(prepare(shapes::icosphere(4, 1), 3, 8 * k_megabyte, 32));
}

TEST(NearFloods, EndWithTheRingThatHasEnough) {
    const TriangleMesh mesh = shapes::grid(21, 21, 20);  // unit squares
    const VertexNeighbors neighbors = build_vertex_neighbors(mesh.faces, mesh.vertex_count());
    const std::uint32_t center = 10 * 22 + 10;
    const auto count = [&](std::size_t enough, Nearness nearness) {
        NearFlood flood(neighbors, enough);
        return flood.around(center, [&](std::uint32_t) { return nearness; }).size();
    };
    EXPECT_EQ(count(6, Nearness::inside), 6);       // the first ring
    EXPECT_EQ(count(7, Nearness::inside), 6 + 12);  // and the second
    EXPECT_EQ(count(7, Nearness::margin), mesh.vertex_count() - 1);
    EXPECT_EQ(count(7, Nearness::outside), 0);
}

TEST(NearFloods, DoNotPassOverVerticesOfManyNeighbors) {
    const TriangleMesh mesh = cone(100);
    const VertexNeighbors neighbors = build_vertex_neighbors(mesh.faces, mesh.vertex_count());
    const auto all = [](std::uint32_t) { return Nearness::inside; };
    NearFlood flood(neighbors, 20);
    EXPECT_EQ(flood.around(0, all).size(), 100);  // around the tip
    const std::span<const std::uint32_t> beside = flood.around(1, all);
    EXPECT_EQ(beside.size(), 21);  // the tip, and ten on both sides
    EXPECT_EQ(std::ranges::max(beside.subspan(0, 3)), 100);
    EXPECT_EQ(std::ranges::count(beside, 50), 0);
}

}  // namespace
}  // namespace exemplar
