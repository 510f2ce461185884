#include "host/mesh/curvature/tensor_diffusion.h"

#include <gtest/gtest.h>

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

void prepare(const TriangleMesh& mesh, double width, std::size_t max_bytes) {
    std::vector<TangentFrame> frames;
    for (const Vec3& vertex : mesh.vertices) frames.push_back(frame_of_normal(vertex.normalized()));
    const VertexNeighbors neighbors = build_vertex_neighbors(mesh.faces, mesh.vertex_count());
    TensorDiffusion diffusion(neighbors, max_bytes);
    diffusion.prepare(mesh.vertices, frames, std::vector<float>(mesh.vertex_count(), 1), width);
}

// Every kernel of the cone holds about a third of it: the square of its vertices in all, which must not fill the
// memory.
TEST(TensorDiffusion, RefusesKernelsThatFillTheMemory) {
    constexpr std::size_t k_megabyte = 1 << 20;
    EXPECT_NO_THROW(prepare(shapes::icosphere(4, 1), 0.05, k_megabyte));
    EXPECT_NO_THROW(prepare(cone(100), 0.5, k_megabyte));
    EXPECT_THROW(prepare(cone(1000), 0.5, k_megabyte), UsageError);
}

}  // namespace
}  // namespace exemplar
