#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "gpu/lines/animation_renderer.h"
#include "host/lines/extraction/drawable_surface.h"
#include "tests/gpu/support/environment.h"
#include "tests/parity/surfaces.h"
#include "tests/parity/tensors.h"

namespace exemplar {
namespace {

using shared::vec4;
using test_support::download;
using test_support::shared_device;

constexpr CurvatureOptions k_measured{.derivatives = true, .smoothing = 1};

/// A sequence of two shapes of a can, whose rims are sharp in both; the second is longer.
Animation growing_can() {
    Animation animation;
    animation.kind = AnimationKind::sequence;
    animation.rest = shapes::cylinder(0.5f, 1, 24, 6, true);
    Clip clip;
    clip.frames = {animation.rest.vertices, animation.rest.vertices};
    for (Vec3& vertex : clip.frames[1]) vertex.z() *= 1.5f;
    animation.clips.push_back(std::move(clip));
    return animation;
}

double largest_distance(const std::vector<vec4>& device, std::span<const Vec3> host) {
    double largest = 0;
    for (std::size_t i = 0; i < host.size(); ++i)
        largest =
            std::max(largest, double{(Vec3(device[i].x, device[i].y, device[i].z) - host[i]).cwiseAbs().maxCoeff()});
    return largest;
}

void expect_parity(const GpuCurvedSurface& device, const LineSurface& host) {
    const auto count = host.vertices.size();
    ASSERT_EQ(device.vertices.bytes(), count * sizeof(vec4));
    EXPECT_EQ(largest_distance(download(device.vertices), host.vertices), 0);
    EXPECT_LT(largest_distance(download(device.normals), host.normals), 1e-5);
    const VertexCurvature found = test_support::download_curvature(*device.first, *device.second, *device.derivative);
    double largest = 0;
    for (std::size_t i = 0; i < count; ++i)
        largest = std::max({largest, std::abs(double{found.k1[i]} - host.curvature.k1[i]),
                            std::abs(double{found.k2[i]} - host.curvature.k2[i])});
    EXPECT_LT(largest, 1e-4);
}

class CutSurfaceParity : public ::testing::TestWithParam<bool> {};

TEST_P(CutSurfaceParity, ShapesAndCurvatureAreThoseOfTheReference) {
    const bool cut_curvature = GetParam();
    const Animation can = growing_can();
    AnimationRenderer renderer(shared_device(), can, k_measured);
    renderer.set_cut_curvature(cut_curvature);
    DrawableSurface drawable(can.rest.faces, can.rest.vertices,
                             {.curvature = k_measured, .cut_curvature = cut_curvature});
    Stream stream(shared_device());
    for (const std::uint32_t frame : {0u, 1u}) {
        renderer.record(stream, FrameRef{0, frame}, CurvatureSource::estimated);
        stream.finish();
        drawable.measure(can.clips[0].frames[frame]);
        ASSERT_GT(drawable.surface().vertices.size(), can.rest.vertex_count());
        expect_parity(renderer.snapshot(), drawable.surface());
    }
}

INSTANTIATE_TEST_SUITE_P(WholeAndInParts, CutSurfaceParity, ::testing::Bool());

TEST(CutSurfaceParityOfAll, CurvatureIsNotNeeded) {
    const Animation can = growing_can();
    AnimationRenderer renderer(shared_device(), can, k_measured);
    renderer.set_cut_curvature(true);
    Stream stream(shared_device());
    renderer.record(stream, FrameRef{0, 1}, CurvatureSource::none);
    stream.finish();
    EXPECT_EQ(renderer.snapshot().first, nullptr);
    DrawableSurface drawable(can.rest.faces, can.rest.vertices);
    drawable.measure(can.clips[0].frames[1]);
    EXPECT_LT(largest_distance(download(renderer.snapshot().normals), drawable.surface().normals), 1e-5);
}

}  // namespace
}  // namespace exemplar
