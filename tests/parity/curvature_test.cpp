#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "gpu/curvature/animated_surface.h"
#include "gpu/curvature/surface/curvature.h"
#include "gpu/curvature/surface/near_vertices.h"
#include "gpu/curvature/surface/poser.h"
#include "host/core/errors.h"
#include "host/curvature/state/samples.h"
#include "host/mesh/curvature/curvature.h"
#include "host/mesh/curvature/near_flood.h"
#include "tests/gpu/support/environment.h"
#include "tests/parity/many_frames.h"
#include "tests/parity/surfaces.h"
#include "tests/parity/tensors.h"
#include "tests/support/bending_tube.h"

// Both round normals to single precision, and the device computes them in it: they differ by a few 1e-7, and the fits
// divide their differences by the height of a face, for derivatives twice. So forms agree to a few 1e-7 over the least
// height around a vertex, and derivatives over its square; worst seen is 2e-7. Large tensors also round themselves.
namespace exemplar {
namespace {

using test_support::derivative_in_space;
using test_support::distance;
using test_support::download;
using test_support::form_in_space;
using test_support::random_pose;
using test_support::same_bits;
using test_support::shared_device;
using test_support::size_of;
using test_support::strip;
using test_support::Tensor2;
using test_support::Tensor3;
using test_support::waved;

constexpr double k_curvature_tolerance = 1e-6;

// Of a frame of a surface that was made at rest.
VertexCurvature device_curvature(const TriangleMesh& rest, const std::vector<Vec3>& vertices,
                                 const CurvatureOptions& options = {}) {
    const GpuSurface surface(shared_device(), rest);
    GpuCurvature curvature(surface, options);
    Stream stream(shared_device());
    curvature.record(stream, test_support::upload_vertices(shared_device(), vertices));
    stream.finish();
    return test_support::download_curvature(curvature);
}

VertexCurvature device_curvature(const TriangleMesh& mesh) {
    return device_curvature(mesh, mesh.vertices);
}

// Per vertex, the least height of the faces around it: the length that differences of normals are divided by.
std::vector<double> min_heights(const TriangleMesh& mesh) {
    std::vector<double> heights(mesh.vertex_count(), std::numeric_limits<double>::infinity());
    for (const auto& [a, b, c] : mesh.faces) {
        const auto at = [&](std::uint32_t v) -> Vec3d { return mesh.vertices[v].cast<double>(); };
        const double longest = std::max({(at(b) - at(a)).norm(), (at(c) - at(b)).norm(), (at(a) - at(c)).norm()});
        const double height = (at(b) - at(a)).cross(at(c) - at(a)).norm() / longest;
        if (!(height > 1e-6 * longest)) continue;
        for (const std::uint32_t v : {a, b, c}) heights[v] = std::min(heights[v], height);
    }
    return heights;
}

// Smoothing gives a vertex that only faces without area have what the other vertices of these faces have, and so its
// error.
std::vector<double> smoothed_min_heights(const TriangleMesh& mesh) {
    const std::vector<double> heights = min_heights(mesh);
    std::vector<double> smoothed = heights;
    for (const Face& face : mesh.faces)
        for (const std::uint32_t v : face)
            for (const std::uint32_t other : face)
                if (std::isinf(heights[v])) smoothed[v] = std::min(smoothed[v], heights[other]);
    return smoothed;
}

// `heights` are those of min_heights or smoothed_min_heights.
void expect_near_curvature(const TriangleMesh& mesh, const std::vector<double>& heights, const VertexCurvature& actual,
                           const VertexCurvature& expected, double tolerance) {
    ASSERT_EQ(actual.k1.size(), expected.k1.size());
    const std::vector<Vec3> normals = vertex_normals(mesh);
    for (std::size_t v = 0; v < normals.size(); ++v) {
        const Vec3 normal = actual.e1[v].cross(actual.e2[v]);
        ASSERT_LE((normal - normals[v]).norm(), 10 * tolerance) << "vertex " << v;
        ASSERT_GE(actual.k1[v], actual.k2[v]) << "vertex " << v;
        const Tensor2 form = form_in_space(expected, v);
        ASSERT_LE((form_in_space(actual, v) - form).norm(), tolerance * (1 / heights[v] + form.norm()))
            << "vertex " << v << ": curvatures " << actual.k1[v] << " and " << actual.k2[v] << " instead of "
            << expected.k1[v] << " and " << expected.k2[v];
        const Tensor3 derivative = derivative_in_space(expected, v);
        ASSERT_LE(distance(derivative_in_space(actual, v), derivative),
                  tolerance * (1 / (heights[v] * heights[v]) + size_of(derivative)))
            << "vertex " << v;
    }
}

void expect_curvature_parity(const TriangleMesh& mesh, double tolerance = k_curvature_tolerance) {
    expect_near_curvature(mesh, min_heights(mesh), device_curvature(mesh), estimate_curvature(mesh, true), tolerance);
}

// Smoothed in units of the mesh at rest, of a frame of it.
void expect_smoothed_parity(const TriangleMesh& rest, const std::vector<Vec3>& vertices, double smoothing) {
    CurvatureEstimator reference(rest.faces, rest.vertex_count());
    CurvatureOptions options{.smoothing = smoothing};
    const VertexCurvature actual = device_curvature(rest, vertices, options);
    options.smoothing_unit = reference.median_edge_length(rest.vertices);
    TriangleMesh frame = rest;
    frame.vertices = vertices;
    expect_near_curvature(frame, smoothed_min_heights(frame), actual, reference.estimate(vertices, options),
                          k_curvature_tolerance);
}

// With a vertex of no face, three on a line and their face, one where another is, and faces that name a vertex twice.
TriangleMesh with_junk(TriangleMesh mesh) {
    const auto first = static_cast<std::uint32_t>(mesh.vertex_count());
    mesh.vertices.insert(mesh.vertices.end(), {{9, 9, 9}, {0, 5, 5}, {1, 5, 5}, {2, 5, 5}, Vec3(mesh.vertices[0])});
    for (const Face& face :
         {Face{first + 1, first + 2, first + 3}, Face{3, 3, 8}, Face{7, 7, 7}, Face{0, first + 4, 1}})
        mesh.faces.push_back(face);
    return mesh;
}

TEST(CurvatureParity, OddNumbersOfVerticesAndFaces) {
    for (const std::size_t vertices : {0u, 1u, 2u, 3u, 63u, 64u, 65u, 66u, 67u, 257u}) {
        SCOPED_TRACE(vertices);
        expect_curvature_parity(strip(vertices));
    }
}

TEST(CurvatureParity, ClosedAndBoundedSurfaces) {
    expect_curvature_parity(waved(shapes::icosphere(3, 1), 0.2f));
    expect_curvature_parity(waved(shapes::torus(2, 0.7f, 40, 17), 0.1f));
    expect_curvature_parity(waved(shapes::grid(13, 9, 2), 0.3f));
    expect_curvature_parity(waved(shapes::cylinder(1, 3, 19, 7, false), 0.2f));
    expect_curvature_parity(shapes::box(1, 2, 3, 4));
    expect_curvature_parity(shapes::icosphere(3, 1));
}

TEST(CurvatureParity, DegenerateFacesAndLooseVertices) {
    const TriangleMesh clean = waved(shapes::icosphere(2, 1), 0.2f), mesh = with_junk(clean);
    expect_curvature_parity(mesh);
    const VertexCurvature actual = device_curvature(mesh);
    for (std::size_t v = clean.vertex_count(); v < mesh.vertex_count() - 1; ++v) {
        EXPECT_EQ(actual.k1[v], 0.0f);
        EXPECT_EQ(actual.k2[v], 0.0f);
        EXPECT_EQ(actual.derivative[v], (std::array<float, 4>{}));
    }
}

// Slivers a hundred times as long as high lose digits of their height, and in sharp folds the normals of a face turn
// far.
TEST(CurvatureParity, NeedlesAndCaps) {
    for (const Vec3& stretch : {Vec3(100, 1, 1), Vec3(1, 100, 1), Vec3(1, 0.01f, 1)}) {
        SCOPED_TRACE(stretch.transpose());
        expect_curvature_parity(shapes::transformed(waved(shapes::torus(2, 0.7f, 30, 20), 0.1f),
                                                    [&](const Vec3& p) -> Vec3 { return p.cwiseProduct(stretch); }),
                                20 * k_curvature_tolerance);
    }
}

// Edges of three faces, doubled faces.
TEST(CurvatureParity, SurfacesThatAreNotManifold) {
    TriangleMesh mesh = waved(shapes::grid(6, 6, 2), 0.3f);
    mesh.vertices.push_back({1, 1, 1});
    const auto apex = static_cast<std::uint32_t>(mesh.vertex_count() - 1);
    for (std::uint32_t v = 16; v < 20; ++v) mesh.faces.push_back({v, v + 1, apex});
    mesh.faces.push_back(mesh.faces[7]);
    expect_curvature_parity(mesh);
}

// Where orientations clash, faces turn away from the normals of their corners, and frames have hardly a least rotation
// between them: what comes out is as good as noise, but finite.
TEST(CurvatureParity, ClashingOrientationsStayFinite) {
    TriangleMesh mesh = waved(shapes::grid(9, 9, 2), 0.3f);
    for (std::size_t f = 0; f < mesh.face_count(); f += 5) std::swap(mesh.faces[f][0], mesh.faces[f][1]);
    const TriangleMesh flipped = mesh;
    mesh.faces.insert(mesh.faces.end(), flipped.faces.begin(), flipped.faces.begin() + 20);
    for (std::size_t f = 20; f < 40; ++f) mesh.faces.push_back({mesh.faces[f][1], mesh.faces[f][0], mesh.faces[f][2]});
    const VertexCurvature actual = device_curvature(mesh);
    for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
        ASSERT_TRUE(std::isfinite(actual.k1[v]) && std::isfinite(actual.k2[v])) << "vertex " << v;
        ASSERT_NEAR(actual.e1[v].norm(), 1.0f, 1e-5f) << "vertex " << v;
        for (const float d : actual.derivative[v]) ASSERT_TRUE(std::isfinite(d)) << "vertex " << v;
    }
}

// A fine ball beside a coarse floor: without a bound, the kernel of each vertex of the ball would hold all of it.
TEST(SmoothedCurvatureParity, KernelsThatAreBounded) {
    const TriangleMesh ball = waved(shapes::icosphere(4, 0.5f), 0.1f);
    ASSERT_GT(ball.vertex_count(), 4 * enough_near_vertices(1));
    const TriangleMesh mesh = shapes::joined(ball, shapes::grid(60, 60, 100));
    expect_smoothed_parity(mesh, mesh.vertices, 1);
}

TEST(SmoothedCurvatureParity, OddNumbersOfVerticesAndFaces) {
    for (const std::size_t vertices : {0u, 1u, 2u, 3u, 63u, 64u, 65u, 66u, 67u, 257u}) {
        SCOPED_TRACE(vertices);
        const TriangleMesh mesh = strip(vertices);
        expect_smoothed_parity(mesh, mesh.vertices, 1);
    }
}

TEST(SmoothedCurvatureParity, ClosedAndBoundedSurfaces) {
    for (const double smoothing : {0.2, 1.0, 2.5})
        for (const TriangleMesh& mesh :
             {waved(shapes::icosphere(3, 1), 0.2f), waved(shapes::torus(2, 0.7f, 40, 17), 0.1f),
              waved(shapes::grid(13, 9, 2), 0.3f), waved(shapes::cylinder(1, 3, 19, 7, false), 0.2f),
              shapes::box(1, 2, 3, 4)}) {
            SCOPED_TRACE(::testing::Message() << mesh.vertex_count() << " vertices by " << smoothing);
            expect_smoothed_parity(mesh, mesh.vertices, smoothing);
        }
}

// A tube that bends over a quarter circle: stretched outside, pressed together inside.
std::vector<Vec3> bent(const TriangleMesh& tube, float length, float angle) {
    std::vector<Vec3> vertices;
    const float radius = length / angle;
    for (const Vec3& p : tube.vertices) {
        const float turn = p.z() / radius;
        vertices.push_back({(p.x() + radius) * std::cos(turn) - radius, p.y(), (p.x() + radius) * std::sin(turn)});
    }
    return vertices;
}

TEST(SmoothedCurvatureParity, PosesFarFromRest) {
    const TriangleMesh tube = waved(shapes::cylinder(1, 12, 40, 80, false), 0.05f);
    for (const float angle : {0.3f, 1.0f, 1.5f}) {
        SCOPED_TRACE(angle);
        expect_smoothed_parity(tube, bent(tube, 12, angle), 1.5);
    }
}

// What comes near from beyond the reach has little weight: the kernel ends at zero.
TEST(SmoothedCurvatureParity, PressedBeyondReachOnlyTheRimIsMissing) {
    const TriangleMesh rest = waved(shapes::grid(40, 40, 4), 0.1f);
    const TriangleMesh pressed = shapes::transformed(rest, [](const Vec3& p) -> Vec3 {
        return {p.x() / 2, p.y(), p.z()};
    });
    CurvatureEstimator reference(rest.faces, rest.vertex_count());
    CurvatureOptions options{.derivatives = false, .smoothing = 1.5};
    const VertexCurvature actual = device_curvature(rest, pressed.vertices, options);
    options.smoothing_unit = reference.median_edge_length(rest.vertices);
    const VertexCurvature expected = reference.estimate(pressed.vertices, options);
    double error = 0, size = 0;
    for (std::size_t v = 0; v < rest.vertex_count(); ++v) {
        error += (form_in_space(actual, v) - form_in_space(expected, v)).squaredNorm();
        size += form_in_space(expected, v).squaredNorm();
    }
    EXPECT_LE(std::sqrt(error / size), 0.08);
}

TEST(SmoothedCurvatureParity, DegenerateFacesAndLooseVertices) {
    const TriangleMesh mesh = with_junk(waved(shapes::icosphere(2, 1), 0.2f));
    expect_smoothed_parity(mesh, mesh.vertices, 1.5);
}

TEST(SmoothedCurvatureParity, MeshesOfAnyScale) {
    const TriangleMesh mesh = waved(shapes::icosphere(2, 1), 0.2f);
    for (const float scale : {1e-15f, 1e-6f, 1e6f, 1e15f}) {
        SCOPED_TRACE(scale);
        const TriangleMesh scaled = shapes::scaled(mesh, scale);
        expect_smoothed_parity(scaled, scaled.vertices, 1);
    }
}

// Each row lies whole in the tile of its vertex, and each vertex is in one.
TEST(NearVertices, AreTiledToTheLimit) {
    const NearVertices rows =
        build_near_vertices(waved(shapes::icosphere(3, 1), 0.2f), {.radius = 0.4, .reach = 0.4}, 1'000'000);
    for (const std::size_t most : {std::size_t{40}, std::size_t{1000}, rows.texels.size() + 4})
        for (const std::size_t alignment : {1u, 4u, 16u}) {
            std::uint32_t next = 0;
            for (const NearTile& tile : tile_rows(rows, most, alignment)) {
                EXPECT_EQ(tile.first, next);
                EXPECT_EQ(tile.first_texel % alignment, 0u);
                EXPECT_LE(tile.texels, most);
                EXPECT_LE(tile.first_texel, rows.begin[tile.first]);
                next = tile.first + tile.count;
                EXPECT_EQ(tile.first_texel + tile.texels,
                          next < rows.begin.size() ? rows.begin[next] : rows.texels.size());
            }
            EXPECT_EQ(next, rows.begin.size());
        }
    EXPECT_THROW(tile_rows(rows, 3, 1), UsageError);
}

TEST(SmoothedCurvatureParity, RefusesWhatTheDeviceCannotDo) {
    const GpuSurface surface(shared_device(), shapes::icosphere(1, 1));
    const auto refused = [&](const CurvatureOptions& options) {
        EXPECT_THROW(GpuCurvature(surface, options), UsageError);
    };
    refused({.smoothing = -1});
    refused({.smoothing = std::numeric_limits<double>::infinity()});
    refused({.smoothing = 1, .smoothing_unit = std::numeric_limits<double>::quiet_NaN()});
    refused({.robust = RobustEstimator::cauchy});
    EXPECT_THROW(build_near_vertices(surface.rest(), {.radius = 1, .reach = 1}, 41), UsageError);
}

// Fourth powers of lengths would leave the range of single precision.
TEST(CurvatureParity, MeshesOfAnyScale) {
    const TriangleMesh mesh = waved(shapes::icosphere(2, 1), 0.2f);
    for (const float scale : {1e-15f, 1e-6f, 1e6f, 1e15f}) {
        SCOPED_TRACE(scale);
        expect_curvature_parity(shapes::scaled(mesh, scale));
    }
}

TEST(CurvatureParity, WithoutDerivatives) {
    const TriangleMesh mesh = waved(shapes::icosphere(2, 1), 0.2f);
    const GpuSurface surface(shared_device(), mesh);
    GpuCurvature with(surface), without(surface, {.derivatives = false});
    const Buffer vertices = test_support::upload_vertices(shared_device(), mesh.vertices);
    Stream stream(shared_device());
    with.record(stream, vertices);
    without.record(stream, vertices);
    stream.finish();
    EXPECT_TRUE(same_bits(download(with.first()), download(without.first())));
    EXPECT_TRUE(same_bits(download(with.second()), download(without.second())));
    EXPECT_FALSE(without.derivative());
}

TEST(CurvatureParity, RefusesVerticesOfAnotherSurface) {
    const GpuSurface surface(shared_device(), shapes::icosphere(1, 1));
    GpuCurvature curvature(surface);
    Stream stream(shared_device());
    EXPECT_THROW(curvature.record(stream, test_support::upload_vertices(shared_device(), std::vector<Vec3>(41))),
                 UsageError);
}

// Files may bind vertices in another unit than that of poses; what is near is so in poses.
TEST(SmoothedCurvatureParity, TheScaleOfTheBindSpaceDoesNotMatter) {
    Animation tube = shapes::tube_rig();
    tube.clips = {shapes::bending_clip(tube, 2, 60, 3)};
    for (Vec3& p : tube.rest.vertices) p *= 5000.0f;
    for (Bone& bone : tube.rig.bones) bone.inverse_bind.linear() /= 5000.0f;
    const GpuSurface surface(shared_device(), first_shape(tube));
    const CurvatureOptions options{.smoothing = 1, .smoothing_unit = 0.25};
    GpuAnimatedSurface moving(surface, tube, options);
    Stream stream(shared_device());
    moving.record(stream, shape_at(tube, 0, 1), CurvatureSource::estimated);
    stream.finish();
    const GpuCurvedSurface snapshot = moving.snapshot();
    TriangleMesh frame = tube.rest;
    frame.vertices = frame_vertices(tube, tube.clips[0], 1);
    CurvatureEstimator reference(frame.faces, frame.vertex_count());
    expect_near_curvature(frame, min_heights(frame),
                          test_support::download_curvature(*snapshot.first, *snapshot.second, *snapshot.derivative),
                          reference.estimate(frame.vertices, options),
                          10 * k_curvature_tolerance);  // posed in another order of sums
}

// A character of many frames: each is what it would be alone, reruns are equal bit for bit, and nothing grows.
TEST(CurvatureParity, ManyFramesOfARig) {
    Random random(9);
    const TriangleMesh rest = waved(shapes::icosphere(2, 1), 0.2f);
    const Rig rig = test_support::random_rig(rest.vertex_count(), 12, 5, random);
    const GpuSurface surface(shared_device(), rest);
    GpuPoser poser(shared_device(), rig, rest.vertices);
    GpuCurvature curvature(surface, {.smoothing = 1});
    Stream stream(shared_device());
    std::vector<Pose> poses;
    poses.reserve(10);
    for (int i = 0; i < 10; ++i) poses.push_back(random_pose(rig, random));
    const auto run = [&](const Pose& pose) {
        poser.record(stream, pose);
        curvature.record(stream, poser.vertices());
        stream.finish();
        return std::array{download(curvature.first()), download(curvature.second()), download(curvature.derivative())};
    };
    test_support::expect_repeatable_without_growth(poses, run);
}

}  // namespace
}  // namespace exemplar
