#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "gpu/curvature/learned/learned_curvature.h"
#include "gpu/curvature/learned/local_state.h"
#include "gpu/curvature/surface/normals.h"
#include "gpu/curvature/surface/poser.h"
#include "gpu/runtime/vulkan/errors.h"
#include "host/core/errors.h"
#include "host/curvature/learning/model_builder.h"
#include "host/curvature/learning/training.h"
#include "host/curvature/model/tiling.h"
#include "tests/gpu/support/environment.h"
#include "tests/parity/many_frames.h"
#include "tests/parity/random_model.h"
#include "tests/parity/surfaces.h"
#include "tests/parity/tensors.h"
#include "tests/support/bending_tube.h"

// Both read the same halves and round sums of a few dozen products to single precision, in another order each: relative
// to themselves and one, tensors agree to a few 1e-6. Where edges stand steep, or normals are far from those in
// training, the tangent frame divides by as little as 0.05.
namespace exemplar {
namespace {

using shared::vec4;
using test_support::derivative_in_space;
using test_support::distance;
using test_support::download;
using test_support::form_in_space;
using test_support::shared_device;
using test_support::size_of;

using test_support::RandomModel;
using test_support::Shape;
using test_support::Surface;

constexpr double k_learned_tolerance = 1e-5;
// Inputs of local shape are sums of a hundred products of such roundings, and of edges, which are differences of
// rounded positions up to forty times as long; components are sums of these.
constexpr double k_local_tolerance = 1e-4;

void expect_near_learned(const VertexCurvature& actual, const VertexCurvature& expected,
                         double tolerance = k_learned_tolerance) {
    ASSERT_EQ(actual.k1.size(), expected.k1.size());
    for (std::size_t v = 0; v < expected.k1.size(); ++v) {
        ASSERT_GE(actual.k1[v], actual.k2[v]) << "vertex " << v;
        const test_support::Tensor2 form = form_in_space(expected, v);
        ASSERT_LE((form_in_space(actual, v) - form).norm(), tolerance * (1 + form.norm()))
            << "vertex " << v << ": curvatures " << actual.k1[v] << " and " << actual.k2[v] << " instead of "
            << expected.k1[v] << " and " << expected.k2[v];
        const test_support::Tensor3 derivative = derivative_in_space(expected, v);
        ASSERT_LE(distance(derivative_in_space(actual, v), derivative), tolerance * (1 + size_of(derivative)))
            << "vertex " << v;
    }
}

struct DeviceSurface {
    explicit DeviceSurface(const Surface& surface)
        : vertices(test_support::upload_vertices(shared_device(), surface.vertices)),
          normals(test_support::upload_vertices(shared_device(), surface.normals)) {}
    GpuLearnedCurvature::Frame frame(const Rig& rig, const Pose& pose) const {
        return {.vertices = vertices, .normals = normals, .rig = &rig, .pose = &pose};
    }
    Buffer vertices, normals;
};

void expect_learned_parity(const Shape& shape, const ReprojectionOptions& options = {}) {
    RandomModel random(shape, 7 + shape.vertices);
    CurvatureEvaluator reference(random.model);
    GpuLearnedCurvature curvature(shared_device(), random.model, options);
    Stream stream(shared_device());
    for (const bool anywhere : {false, true}) {
        const Pose pose = random.pose();
        const Surface surface = random.surface(pose, anywhere);
        const DeviceSurface on_device(surface);
        curvature.record(stream, on_device.frame(random.rig, pose));
        stream.finish();
        expect_near_learned(test_support::download_curvature(curvature),
                            reference.evaluate(random.rig, pose, surface.vertices, surface.normals),
                            anywhere ? 10 * k_learned_tolerance : k_learned_tolerance);
        EXPECT_EQ(curvature.farthest().control, reference.farthest().control);
        EXPECT_EQ(curvature.farthest().distance, reference.farthest().distance);
    }
}

constexpr std::array k_sets{AttributeSet::tensor, AttributeSet::principal};

TEST(LearnedCurvatureParity, OddNumbersOfVertices) {
    for (const AttributeSet set : k_sets)
        for (const std::size_t vertices : {1u, 2u, 15u, 16u, 17u, 63u, 64u, 65u, 1023u}) {
            SCOPED_TRACE(vertices);
            expect_learned_parity({.vertices = vertices, .set = set, .segments = std::min<std::size_t>(vertices, 3)});
        }
}

TEST(LearnedCurvatureParity, WithoutComponents) {
    for (const AttributeSet set : k_sets) expect_learned_parity({.set = set, .blocks = 0});
}

TEST(LearnedCurvatureParity, ManySegments) {
    expect_learned_parity({.vertices = 900, .set = AttributeSet::principal, .segments = 300});
}

TEST(LearnedCurvatureParity, Neurons) {
    for (const AttributeSet set : k_sets)
        for (const std::size_t neurons : {1u, 4u, 21u}) expect_learned_parity({.set = set, .neurons = neurons});
    expect_learned_parity({.blocks = 0, .neurons = 7});
}

TEST(LearnedCurvatureParity, ManyComponents) {
    expect_learned_parity({.vertices = 50, .blocks = 60, .max_components = 30});
}

TEST(LearnedCurvatureParity, BasesInManyRanges) {
    for (const AttributeSet set : k_sets)
        expect_learned_parity({.vertices = 700, .set = set}, {.max_texels_per_range = 700});
}

// What suits another device than this.
TEST(LearnedCurvatureParity, AnyNumberOfVerticesPerInvocation) {
    for (const AttributeSet set : k_sets)
        for (const std::uint32_t quads : {1u, 2u, 4u})
            for (const std::size_t vertices : {16u, 65u, 700u})
                expect_learned_parity({.vertices = vertices, .set = set}, {.quads = quads});
}

TEST(LearnedCurvatureParity, OppositeNormalsAndUprightEdgesStayFinite) {
    for (const AttributeSet set : k_sets) {
        RandomModel random({.set = set}, 4);
        const Pose pose = random.pose();
        GpuLearnedCurvature curvature(shared_device(), random.model);
        Stream stream(shared_device());
        const Surface surface = random.degenerate_surface(pose);
        const DeviceSurface on_device(surface);
        curvature.record(stream, on_device.frame(random.rig, pose));
        stream.finish();
        const VertexCurvature actual = test_support::download_curvature(curvature);
        if (set == AttributeSet::tensor)
            expect_near_learned(
                actual, CurvatureEvaluator(random.model).evaluate(random.rig, pose, surface.vertices, surface.normals));
        for (std::size_t v = 0; v < actual.k1.size(); ++v) {
            ASSERT_TRUE(std::isfinite(actual.k1[v]) && std::isfinite(actual.k2[v])) << "vertex " << v;
            ASSERT_TRUE(actual.e1[v].allFinite() && actual.e2[v].allFinite()) << "vertex " << v;
            for (const float d : actual.derivative[v]) ASSERT_TRUE(std::isfinite(d)) << "vertex " << v;
        }
    }
}

CurvatureModel trained(const Animation& animation, const CurvatureTraining& options) {
    std::vector<FrameRef> frames;
    for (std::uint32_t f = 0; f < 40; ++f) frames.push_back({0, f});
    CurvatureTrainingReport report;
    return train_curvature(animation, frames, options, report);
}

std::vector<Vec3> download_vectors(const Buffer& buffer) {
    std::vector<Vec3> vectors;
    for (const vec4& v : download(buffer)) vectors.push_back(test_support::xyz(v));
    return vectors;
}

TEST(LearnedCurvatureParity, TrainedOnARig) {
    const Animation tube = shapes::bending_tube();
    const GpuSurface surface(shared_device(), tube.rest);
    GpuPoser poser(shared_device(), tube.rig, tube.rest.vertices);
    GpuNormals normals(surface);
    Stream stream(shared_device());
    for (const AttributeSet set : k_sets)
        for (const Learner learner : {Learner::local, Learner::additive, Learner::averaged}) {
            const CurvatureModel model = trained(tube, {.attributes = set, .learner = learner, .augmented_poses = 20});
            GpuLearnedCurvature curvature(shared_device(), model);
            CurvatureEvaluator reference(model);
            for (const Pose& pose : {tube.clips[1].poses[0], tube.clips[1].poses[7]}) {
                poser.record(stream, pose);
                normals.record(stream, poser.vertices());
                curvature.record(
                    stream,
                    {.vertices = poser.vertices(), .normals = normals.normals(), .rig = &tube.rig, .pose = &pose});
                stream.finish();
                expect_near_learned(test_support::download_curvature(curvature),
                                    reference.evaluate(tube.rig, pose, download_vectors(poser.vertices()),
                                                       download_vectors(normals.normals())),
                                    learner == Learner::local ? k_local_tolerance : k_learned_tolerance);
            }
        }
}

Animation waving_sheet() {
    Animation sheet;
    sheet.name = "sheet";
    sheet.kind = AnimationKind::sequence;
    sheet.rest = shapes::grid(12, 12, 2);
    Clip clip;
    clip.name = "waves";
    Random random(3);
    for (int f = 0; f < 40; ++f) {
        const float height = float(random.uniform(-0.5, 0.5)), shift = float(random.uniform(-2, 2));
        clip.frames.push_back(shapes::transformed(sheet.rest, [&](const Vec3& p) -> Vec3 {
                                  return p + Vec3(0, 0, height * std::sin(2 * p.x() + shift));
                              }).vertices);
    }
    sheet.clips = {clip};
    return sheet;
}

TEST(LearnedCurvatureParity, TrainedOnASequence) {
    const Animation sheet = waving_sheet();
    const CurvatureModel model = trained(sheet, {.learner = Learner::additive});
    GpuLearnedCurvature curvature(shared_device(), model);
    CurvatureEvaluator reference(model);
    Stream stream(shared_device());
    for (const std::vector<Vec3>& vertices : {sheet.clips[0].frames[3], sheet.clips[0].frames[20]}) {
        TriangleMesh frame = sheet.rest;
        frame.vertices = vertices;
        const std::vector<Vec3> normals = vertex_normals(frame);
        const DeviceSurface on_device({vertices, normals});
        curvature.record(stream,
                         {.vertices = on_device.vertices, .normals = on_device.normals, .host_vertices = vertices});
        stream.finish();
        expect_near_learned(test_support::download_curvature(curvature), reference.evaluate(vertices, normals));
    }
}

/// The same sheet elsewhere, as the device has it too.
struct MovedSheet {
    MovedSheet(const Animation& sheet, std::size_t frame) : mesh(sheet.rest) {
        mesh.vertices = sheet.clips[0].frames[frame];
        for (Vec3& p : mesh.vertices) p = Eigen::AngleAxisf(1.1f, Vec3(1, 2, -1).normalized()) * p + Vec3(2, 0, 1);
        normals = vertex_normals(mesh);
        on_device.emplace(test_support::Surface{mesh.vertices, normals});
    }
    TriangleMesh mesh;
    std::vector<Vec3> normals;
    std::optional<DeviceSurface> on_device;
};

// What rounding may do to each input: numbers of the shape are of size one, but heights, which are differences of
// positions.
std::vector<float> input_roundings(const LocalShapeState& state, const std::vector<Vec3>& vertices) {
    constexpr float k_unit_roundoff = 2 * std::numeric_limits<float>::epsilon();
    float farthest = 0;
    for (const Vec3& p : vertices) farthest = std::max(farthest, p.norm());
    std::vector<float> roundings;
    for (const Eigen::MatrixXf& map : state.map)
        for (Eigen::Index i = 0; i < map.rows(); ++i) {
            float sum = 0;
            for (Eigen::Index j = 0; j < map.cols(); ++j)
                sum += std::abs(map(i, j)) * (j % 4 == 3 ? farthest / state.unit : 1.0f);
            roundings.push_back(k_unit_roundoff * sum);
        }
    return roundings;
}

TEST(LearnedCurvatureParity, ReadsLocalShapeOnTheDevice) {
    const Animation sheet = waving_sheet();
    const CurvatureModel model = trained(sheet, {.learner = Learner::local});
    const std::size_t inputs = model.state.input_count;
    GpuLocalState state(shared_device(), model, inputs + 3);
    GpuLearnedCurvature curvature(shared_device(), model);
    CurvatureEvaluator reference(model);
    Stream stream(shared_device());
    for (const std::size_t frame : {3u, 20u}) {
        const MovedSheet moved(sheet, frame);
        state.record(stream, moved.on_device->vertices, moved.on_device->normals);
        curvature.record(stream, {.vertices = moved.on_device->vertices, .normals = moved.on_device->normals});
        stream.finish();
        std::vector<Eigen::Matrix3f> rotations;
        model.segments.rotations_of_sequence(moved.mesh.vertices, rotations);
        std::vector<float> expected(inputs), actual(inputs + 3);
        state.inputs().download(std::span(actual));
        model.state.read_surface(moved.mesh.vertices, moved.normals, rotations, expected);
        model.range.prepare(model.state, expected);
        const std::vector<float> roundings =
            input_roundings(std::get<LocalShapeState>(model.state.source), moved.mesh.vertices);
        for (std::size_t i = 0; i < inputs; ++i) EXPECT_NEAR(actual[i], expected[i], roundings[i]) << "input " << i;
        EXPECT_EQ(std::vector<float>(actual.begin() + std::ptrdiff_t(inputs), actual.end()),
                  (std::vector<float>{1, 0, 0}));
        const std::vector<vec4> rows = download(state.rotations());
        for (std::size_t i = 0; i < rows.size(); ++i)
            EXPECT_LT((test_support::xyz(rows[i]) - rotations[i / 3].row(Eigen::Index(i % 3)).transpose()).norm(),
                      1e-5f);
        expect_near_learned(test_support::download_curvature(curvature),
                            reference.evaluate(moved.mesh.vertices, moved.normals), k_local_tolerance);
    }
}

TEST(LearnedCurvatureParity, LocalShapeIsOfSequencesThatAreWhole) {
    const Animation sheet = waving_sheet();
    GpuLearnedCurvature read_on_host(shared_device(), trained(sheet, {.learner = Learner::additive}));
    Stream stream(shared_device());
    const Buffer vertices = test_support::upload_vertices(shared_device(), sheet.rest.vertices);
    EXPECT_THROW(read_on_host.record(stream, {.vertices = vertices, .normals = vertices}), UsageError);
    CurvatureModel damaged = trained(sheet, {.learner = Learner::local});
    damaged.segments.triangles.pop_back();
    EXPECT_THROW(GpuLearnedCurvature(shared_device(), damaged), ModelError);
}

TEST(LearnedCurvatureParity, RefusesWhatIsOfAnotherModel) {
    RandomModel random({}, 5);
    GpuLearnedCurvature curvature(shared_device(), random.model);
    Stream stream(shared_device());
    const Buffer all = test_support::upload_vertices(shared_device(), std::vector<Vec3>(200, Vec3::UnitZ())),
                 few = test_support::upload_vertices(shared_device(), std::vector<Vec3>(199, Vec3::UnitZ()));
    const Pose pose = random.pose();
    const auto record = [&](GpuLearnedCurvature& to, const Rig& rig, const Pose& in, const Buffer& vertices,
                            const Buffer& normals) {
        to.record(stream, {.vertices = vertices, .normals = normals, .rig = &rig, .pose = &in});
    };
    EXPECT_THROW(record(curvature, random.rig, pose, all, few), UsageError);
    EXPECT_THROW(record(curvature, random.rig, pose, few, all), UsageError);
    const std::vector<Vec3> on_host(200);
    EXPECT_THROW(curvature.record(stream, {.vertices = all, .normals = all, .host_vertices = on_host}), UsageError);
    Rig shorter = random.rig;
    shorter.nodes.pop_back();
    EXPECT_THROW(record(curvature, shorter, pose, all, all), UsageError);
    RandomModel segmented({.set = AttributeSet::principal}, 5);
    GpuLearnedCurvature principal(shared_device(), segmented.model);
    shorter = segmented.rig;
    shorter.bones.resize(5);
    EXPECT_THROW(record(principal, shorter, segmented.pose(), all, all), UsageError);

    CurvatureModel bad = random.model;
    bad.regression.components.back().first_feature += 100;
    EXPECT_THROW(GpuLearnedCurvature(shared_device(), bad), ModelError);
    bad = random.model;
    bad.state.input_count += 1;
    EXPECT_THROW(GpuLearnedCurvature(shared_device(), bad), ModelError);
    bad = random.model;
    bad.range.mean.conservativeResize(2);
    EXPECT_THROW(GpuLearnedCurvature(shared_device(), bad), ModelError);
    bad = random.model;
    bad.state.controls[1].input_count = 30;
    EXPECT_THROW(GpuLearnedCurvature(shared_device(), bad), ModelError);
    EXPECT_THROW(GpuLearnedCurvature(shared_device(), random.model, {.max_texels_per_range = 20}), DeviceLimitError);
    EXPECT_THROW(GpuLearnedCurvature(shared_device(), random.model, {.quads = 3}), UsageError);
}

// Each frame is what it would be alone, reruns are equal bit for bit, and nothing grows.
TEST(LearnedCurvatureParity, ManyFrames) {
    RandomModel random({.vertices = 300, .neurons = 5}, 9);
    GpuLearnedCurvature curvature(shared_device(), random.model);
    Stream stream(shared_device());
    struct Frame {
        Pose pose;
        DeviceSurface surface;
    };
    std::vector<Frame> frames;
    for (int i = 0; i < 10; ++i) {
        const Pose pose = random.pose();
        frames.push_back({pose, DeviceSurface(random.surface(pose, false))});
    }
    const auto run = [&](const Frame& frame) {
        curvature.record(stream, frame.surface.frame(random.rig, frame.pose));
        stream.finish();
        return std::array{download(curvature.first()), download(curvature.second()), download(curvature.derivative())};
    };
    test_support::expect_repeatable_without_growth(frames, run);
}

}  // namespace
}  // namespace exemplar
